import type { FromWorker, ToWorker } from "./messages.ts";

/** The time (ms) after which a worker that does not answer is ended. */
const PATIENCE = 10_000;

/** The worker that compiles and simulates. One that is broken or does not answer is replaced. */
export class Simulator {
  readonly #receive: (message: FromWorker) => void;
  readonly #replaced: (reason: string) => void;
  #worker: Worker;
  #timer: number | undefined;

  /** `replaced` is called after a worker was replaced, with the reason. The new one knows nothing of the old one. */
  constructor(receive: (message: FromWorker) => void, replaced: (reason: string) => void) {
    [this.#receive, this.#replaced] = [receive, replaced];
    this.#worker = this.#start();
  }

  send(message: ToWorker): void {
    this.#worker.postMessage(message);
    this.#timer ??= setTimeout(() => this.#replace("The simulation did not answer and was stopped."), PATIENCE);
  }

  #start(): Worker {
    const worker = new Worker("worker.js");
    worker.addEventListener("message", ({ data }: MessageEvent<FromWorker>) => {
      clearTimeout(this.#timer);
      this.#timer = undefined;
      if (data.type === "broken") {
        this.#replace(`The simulation broke off: ${data.error}`);
      } else {
        this.#receive(data);
      }
    });
    return worker;
  }

  #replace(reason: string): void {
    this.#worker.terminate();
    clearTimeout(this.#timer);
    this.#timer = undefined;
    this.#worker = this.#start();
    this.#replaced(reason);
  }
}
