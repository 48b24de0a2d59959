import type { Frame, PageMessage } from "./protocol.ts";
import type { Run } from "./run.ts";
import type { Answer } from "./answer.ts";

/** What the page shows: a tick of a run. */
export interface View {
  run: Run;
  /** The shown tick. */
  frame: Frame | undefined;
  /** True if the newest tick is shown. */
  isFollowing: boolean;
  /** The times (s) of the plots. */
  from: number;
  to: number;
  /** The counterfactual beside the run. */
  answer: Answer | undefined;
}

/** What parts of the page can do. */
export interface Actions {
  send(message: PageMessage): void;
  /** Shows a tick, or the newest one. */
  select(tick: number | undefined): void;
  /** Shows the tick that is nearest to a time (s). */
  seek(time: number): void;
  /** Sets the duration (s) of the plots. Infinite for the whole run. */
  zoomTime(duration: number): void;
  /** Adds a breakpoint, or removes it. */
  toggleBreakpoint(text: string): void;
  /** Shows a counterfactual beside the run. */
  compare(answer: Answer | undefined): void;
  /** Shows changes outside of messages. */
  refresh(): void;
}

/** A part of the page. */
export interface Panel {
  readonly element: HTMLElement;
  update(view: View): void;
}
