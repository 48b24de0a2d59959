import { extend, lastIndex, type Span } from "./history.ts";
import type { FirstDifference, Kind, Piece, PieceFrame } from "./protocol.ts";

/** A counterfactual, as far as it was received. */
export class Answer {
  readonly id: number;
  readonly kind: Kind;
  /** The first tick with the change, and its time (s). */
  readonly tick: number;
  readonly time: number;
  readonly set: Readonly<Record<string, number>>;
  readonly frames: PieceFrame[] = [];
  readonly spans: Span[] = [];
  difference: FirstDifference | undefined;
  /** Why it ended. */
  end: string | undefined;
  fault: string | undefined;

  constructor(id: number, kind: Kind, tick: number, time: number, set: Record<string, number>) {
    [this.id, this.kind, this.tick, this.time, this.set] = [id, kind, tick, time, set];
  }

  get isDone(): boolean {
    return this.end !== undefined || this.fault !== undefined;
  }

  add(piece: Piece): void {
    for (const frame of piece.frames) {
      this.frames.push(frame);
      extend(this.spans, frame);
    }
    this.difference = piece.first_difference ?? this.difference;
    if (piece.done) {
      this.end = piece.end ?? "done";
    }
  }

  /** The last tick up to this number. */
  at(tick: number): PieceFrame | undefined {
    return this.frames[lastIndex(this.frames, (frame) => frame.tick <= tick)];
  }
}
