import type { Frame } from "../live/protocol.ts";
import type { FromWorker, Question, ToWorker } from "./messages.ts";

/** The number of looks, one a second, after which a worker that does not answer is ended. */
const PATIENCE = 10;
/** The time (ms) between two looks. */
const LOOK = 1000;

/** The worker that compiles and simulates. One that is broken or does not answer is ended. The next message starts another one. */
export class Simulator {
  readonly #receive: (message: FromWorker) => void;
  readonly #started: () => void;
  readonly #lost: (reason: string) => void;
  readonly #waiting = new Map<number, { resolve: (answer: unknown) => void; reject: (fault: Error) => void }>();
  #next = 1;
  #worker: Worker | undefined;
  /** True as soon as the worker has compiled its module, which takes long on a slow computer and does not count. */
  #isReady = false;
  /** The number of messages that the worker has not yet taken. */
  #pending = 0;
  /** True while a run was asked for and has not begun. */
  #isStarting = false;
  /** The number of looks since the last message of the worker. */
  #looks = 0;

  /** `started` is called for each worker but the first, which knows nothing of the one before, and `lost` with the reason when one has ended. */
  constructor(receive: (message: FromWorker) => void, started: () => void, lost: (reason: string) => void) {
    [this.#receive, this.#started, this.#lost] = [receive, started, lost];
    this.#worker = this.#start();
    // Looks are counted, not time: while the page itself is busy or asleep, neither looks nor answers come.
    setInterval(() => this.#look(), LOOK);
  }

  send(message: ToWorker): void {
    if (this.#worker === undefined) {
      this.#worker = this.#start();
      this.#started();
    }
    this.#isStarting ||= message.type === "start";
    this.#pending += 1;
    this.#worker.postMessage(message);
  }

  /** Asks a question. What is wrong with it is an error. */
  ask(question: Question): Promise<unknown> {
    const id = this.#next++;
    return new Promise((resolve, reject) => {
      this.#waiting.set(id, { resolve, reject });
      this.send({ type: "ask", id, question });
    });
  }

  #answered(id: number, answer: unknown, error: string | undefined): void {
    const waiting = this.#waiting.get(id);
    this.#waiting.delete(id);
    if (error === undefined) {
      waiting?.resolve(answer);
    } else {
      waiting?.reject(new Error(error));
    }
  }

  #look(): void {
    this.#looks = this.#isReady && this.#pending > 0 ? this.#looks + 1 : 0;
    if (this.#looks > PATIENCE) {
      this.#end(`The simulation ${this.#isStarting ? "took too long to start" : "did not answer and was stopped"}. Press run to try again.`);
    }
  }

  #start(): Worker {
    const worker = new Worker("worker.js");
    worker.addEventListener("message", ({ data }: MessageEvent<FromWorker>) => {
      if (worker !== this.#worker) {
        return;
      }
      this.#looks = 0;
      switch (data.type) {
        case "ready": this.#isReady = true; break;
        case "taken": this.#pending -= 1; return;
        case "broken": this.#end(this.#isReady ? `The simulation broke off: ${data.error}. Press run to try again.` : `The simulation cannot be loaded: ${data.error}. Load the page again.`); return;
        case "answered": this.#answered(data.id, data.answer, data.error); return;
        case "refused": this.#isStarting = false; break;
        case "frames": this.#receive({ type: "live", message: { type: "ticks", lost: 0, frames: JSON.parse(data.text) as Frame[] } }); return;
        case "live": this.#isStarting &&= data.message.type !== "hello";
      }
      this.#receive(data);
    });
    worker.addEventListener("error", () => worker === this.#worker && this.#end("The simulation cannot be loaded: worker.js is missing. Load the page again."));
    return worker;
  }

  #end(reason: string): void {
    this.#worker?.terminate();
    [this.#worker, this.#isReady, this.#pending, this.#looks, this.#isStarting] = [undefined, false, 0, 0, false];
    [...this.#waiting.keys()].forEach((id) => this.#answered(id, undefined, reason));
    this.#lost(reason);
  }
}
