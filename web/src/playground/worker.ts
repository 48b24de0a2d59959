import type { BreakpointInfo, Hello, Kind, Metrics, PageMessage, Piece, Status } from "../live/protocol.ts";
import { Machine, Refusal } from "./machine.ts";
import type { Catalog, FromWorker, LanguageMessage, Question, Result, Start, ToWorker } from "./messages.ts";

/** The part of a worker's global scope that is used here. */
interface Scope {
  postMessage(message: FromWorker): void;
  addEventListener(type: "message", listener: (event: MessageEvent<ToWorker>) => void): void;
}
const scope = globalThis as unknown as Scope;

/** The time (ms) for which the worker simulates before it looks for messages. */
const SLICE = 12;
/** The number of ticks in the first request of a slice. */
const PORTION = 8;
/** The number of ticks of a comparison before the worker looks for messages. */
const COMPARED = 120;
/** The largest number of breakpoints. */
const MOST_BREAKPOINTS = 64;

interface Advanced {
  ticks: number;
  time: number;
  has_ended: boolean;
  /** The breakpoint at which it has stopped. */
  breakpoint: string | null;
}

interface Scored {
  result: Result;
  picture: string;
  verdict: string;
  metrics: Metrics;
}

/** The run of the page, and the policies that it is compared with. */
class Worker {
  readonly #machine: Machine;
  readonly #catalog: Catalog;
  #state: Status["state"] = "finished";
  #ticks = 0;
  #speed = Infinity;
  #time = 0;
  /** Wall time (ms) at which the pace began, and the simulated time (s) then. */
  #pace: [number, number] = [0, 0];
  /** Wall time (ms) that the simulation has taken. */
  #used = 0;
  /** The number that the page has given to the run. */
  #run = 0;
  /** True if the first comparison has begun. */
  #isComparing = false;
  /** The texts of the breakpoints, also of those that the policy of this run cannot have. */
  #breakpoints: string[] = [];
  #broken: BreakpointInfo[] = [];
  /** What the page was told last of the state. */
  #shown: Partial<Status> = {};
  /** The number of the counterfactual that is being answered. */
  #question: number | undefined;
  #comparisons: { scenario: string; policy: string; text: string; set: Record<string, number> }[] = [];

  constructor(machine: Machine) {
    this.#machine = machine;
    this.#catalog = machine.ask<Catalog>({ type: "catalog" });
    scope.postMessage({ type: "ready", catalog: this.#catalog });
  }

  receive(message: ToWorker): void {
    switch (message.type) {
      case "start": this.#start(message.run, message.start, message.speed); break;
      case "stop": this.#stop(); break;
      case "speed":
        this.#speed = message.speed;
        this.#pace = [performance.now(), this.#time];
        break;
      case "live": this.#control(message.message); break;
      case "language": scope.postMessage({ type: "language", messages: this.#machine.ask<LanguageMessage[]>({ type: "language", message: message.message }) }); break;
      case "ask": this.#answer(message.id, message.question); break;
      case "compare":
        this.#isComparing = false;
        this.#comparisons = this.#catalog.policies.filter(({ name }) => message.policies.includes(name)).map(({ name, text }) => ({ scenario: message.scenario, policy: name, text, set: message.set }));
    }
    this.#schedule();
  }

  #answer(id: number, question: Question): void {
    try {
      scope.postMessage({ type: "answered", id, answer: this.#machine.ask(question), error: undefined });
    } catch (fault) {
      if (!(fault instanceof Refusal)) {
        throw fault;
      }
      scope.postMessage({ type: "answered", id, answer: undefined, error: fault.message });
    }
  }

  #start(run: number, { scenario, policy, set }: Start, speed: number): void {
    [this.#comparisons, this.#isComparing] = [[], false];
    this.#run = run;
    this.#state = "finished";
    let hello: Hello;
    try {
      hello = this.#machine.ask<Hello>({ type: "start", scenario, policy, set, breakpoints: this.#breakpoints });
    } catch (fault) {
      if (!(fault instanceof Refusal)) {
        throw fault;
      }
      scope.postMessage({ type: "refused", run, error: fault.message });
      return;
    }
    hello.run = run;
    this.#broken = hello.breakpoints;
    this.#question = undefined;
    [this.#state, this.#ticks, this.#time, this.#speed, this.#used] = ["running", 0, 0, speed, 0];
    this.#pace = [performance.now(), 0];
    scope.postMessage({ type: "live", message: hello });
    this.#status();
    this.#advance(1);
  }

  #stop(): void {
    if (this.#state !== "finished") {
      this.#state = "finished";
      this.#status({ verdict: "stopped" });
    }
  }

  #control(message: PageMessage): void {
    switch (message.type) {
      case "break": this.#break(message.add, message.remove); return;
      case "counterfactual": this.#ask(message.id, message); return;
      case "cancel": this.#question = this.#question === message.id ? undefined : this.#question; return;
    }
    if (this.#state === "finished") {
      return;
    }
    switch (message.type) {
      case "pause": this.#state = "paused"; this.#status({ reason: "page" }); break;
      case "run":
        this.#state = "running";
        this.#pace = [performance.now(), this.#time];
        this.#status();
        break;
      case "step":
        this.#advance(message.ticks);
        if (this.#state === "paused") {
          this.#status({ reason: "page" });
        }
    }
  }

  /** Adds a breakpoint or removes one. */
  #break(add: string | null, remove: string | null): void {
    const texts = this.#breakpoints.filter((text) => text !== remove && text !== add);
    if (add !== null) {
      texts.push(add);
    }
    if (texts.length > MOST_BREAKPOINTS) {
      this.#fault(`there are ${MOST_BREAKPOINTS} breakpoints; remove some of them`, null);
      return;
    }
    this.#try(null, () => {
      this.#broken = this.#machine.ask<BreakpointInfo[]>({ type: "break", texts, new: add });
      this.#breakpoints = texts;
      this.#status(this.#shown);
    });
  }

  /** Begins a counterfactual. */
  #ask(id: number, { tick, kind, set }: { tick: number; kind: Kind; set: Record<string, number> }): void {
    this.#question = undefined;
    this.#try(id, () => {
      this.#machine.ask({ type: "counterfactual", id, tick, kind, set });
      this.#question = id;
    });
  }

  /** Goes on with the counterfactual. */
  #reply(): void {
    const id = this.#question;
    if (id !== undefined) {
      this.#try(id, () => {
        this.#question = undefined;
        const piece = this.#machine.ask<Omit<Piece, "type"> | null>({ type: "answer", ticks: COMPARED });
        if (piece !== null) {
          scope.postMessage({ type: "live", message: { type: "counterfactual", ...piece } });
        }
        this.#question = piece?.done ? undefined : id;
      });
    }
  }

  /** Tells the page what the machine refuses. */
  #try(id: number | null, work: () => void): void {
    try {
      work();
    } catch (fault) {
      if (!(fault instanceof Refusal)) {
        throw fault;
      }
      this.#fault(fault.message, id);
    }
  }

  #fault(message: string, id: number | null): void {
    scope.postMessage({ type: "live", message: { type: "error", message, id } });
  }

  /** Simulates ticks and shows them. */
  #advance(ticks: number): void {
    const before = performance.now();
    const { ticks: count, time, has_ended: hasEnded, breakpoint } = this.#machine.ask<Advanced>({ type: "advance", ticks });
    [this.#ticks, this.#time] = [count, time];
    const text = this.#machine.text({ type: "frames" });
    this.#used += performance.now() - before;
    scope.postMessage({ type: "frames", text });
    if (hasEnded) {
      const { result, picture, verdict, metrics } = this.#machine.ask<Scored>({ type: "score" });
      this.#state = "finished";
      // The expectations that are not met are part of the score.
      this.#status({ verdict, reason: result.reason, metrics });
      scope.postMessage({ type: "scored", run: this.#run, result, picture, realtime: (1000 * time) / Math.max(this.#used, 1) });
    } else if (breakpoint !== null) {
      this.#state = "paused";
      this.#status({ reason: "breakpoint", breakpoint });
    }
  }

  #status(changed: Partial<Status> = {}): void {
    this.#shown = changed;
    scope.postMessage({ type: "live", message: { type: "status", state: this.#state, reason: null, breakpoint: null, verdict: null, metrics: null, ticks: this.#ticks, kept_every: 1, breakpoints: this.#broken, ...changed } });
  }

  /** Goes on with the run, or with a comparison, as soon as all messages are read. */
  #schedule(): void {
    if (!this.#isScheduled && (this.#state === "running" || this.#question !== undefined || (this.#state === "finished" && this.#comparisons.length > 0))) {
      this.#isScheduled = true;
      const isAhead = this.#state === "running" && this.#time > this.#allowed();
      setTimeout(() => {
        this.#isScheduled = false;
        this.#work();
        this.#schedule();
      }, isAhead ? 8 : 0);
    }
  }
  #isScheduled = false;

  /** The simulated time (s) that the pace allows. */
  #allowed(): number {
    const [since, from] = this.#pace;
    return from + (this.#speed * (performance.now() - since)) / 1000;
  }

  #work(): void {
    const end = performance.now() + SLICE;
    while (this.#state === "running" && performance.now() < end && this.#time <= this.#allowed()) {
      this.#advance(this.#speed === Infinity ? PORTION : 1);
    }
    this.#reply();
    if (this.#state === "finished") {
      this.#compare();
    }
    scope.postMessage({ type: "alive" });
  }

  /** Goes on with the run of a policy of the program in the scenario of the page. */
  #compare(): void {
    const next = this.#comparisons[0];
    if (next === undefined) {
      return;
    }
    const { scenario, policy, text, set } = next;
    let result: Result | undefined;
    try {
      if (!this.#isComparing) {
        this.#machine.ask({ type: "start", scenario, policy: text, set, beside: true });
        this.#isComparing = true;
        return;
      }
      if (!this.#machine.ask<Advanced>({ type: "advance", ticks: COMPARED, frames: false, beside: true }).has_ended) {
        return;
      }
      result = this.#machine.ask<Scored>({ type: "score", beside: true }).result;
    } catch (fault) {
      if (!(fault instanceof Refusal)) {
        throw fault;
      }
    }
    this.#isComparing = false;
    this.#comparisons.shift();
    scope.postMessage({ type: "compared", scenario, policy, result });
  }
}

const waiting: ToWorker[] = [];
let worker: Worker | undefined;

/** A trap leaves the machine in a state that nobody knows, so the page starts another worker. */
function guard(work: () => void): void {
  try {
    work();
  } catch (fault) {
    scope.postMessage({ type: "broken", error: String(fault) });
  }
}

function receive(message: ToWorker): void {
  worker?.receive(message);
  scope.postMessage({ type: "taken" });
}

scope.addEventListener("message", ({ data }) => {
  if (worker === undefined) {
    waiting.push(data);
  } else {
    guard(() => receive(data));
  }
});
Machine.load("vibrissa.wasm").then(
  (machine) => guard(() => {
    worker = new Worker(machine);
    waiting.splice(0).forEach(receive);
  }),
  (fault: unknown) => scope.postMessage({ type: "broken", error: String(fault) }),
);
