import type { FromWorker, Question, ToWorker } from "./messages.ts";

/** The time (ms) after which a worker that does not answer is ended. */
const PATIENCE = 10_000;

/** The worker that compiles and simulates. One that is broken or does not answer is replaced. */
export class Simulator {
  readonly #receive: (message: FromWorker) => void;
  readonly #replaced: (reason: string) => void;
  readonly #waiting = new Map<number, { resolve: (answer: unknown) => void; reject: (fault: Error) => void }>();
  #next = 1;
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

  /** Asks a question. What is wrong with it is an error. */
  ask(question: Question): Promise<unknown> {
    const id = this.#next++;
    this.send({ type: "ask", id, question });
    return new Promise((resolve, reject) => this.#waiting.set(id, { resolve, reject }));
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

  #start(): Worker {
    const worker = new Worker("worker.js");
    worker.addEventListener("message", ({ data }: MessageEvent<FromWorker>) => {
      clearTimeout(this.#timer);
      this.#timer = undefined;
      if (data.type === "broken") {
        this.#replace(`The simulation broke off: ${data.error}`);
      } else if (data.type === "answered") {
        this.#answered(data.id, data.answer, data.error);
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
    [...this.#waiting.keys()].forEach((id) => this.#answered(id, undefined, reason));
    this.#replaced(reason);
  }
}
