import { element } from "../shared/element.ts";
import type { Answer } from "./answer.ts";
import { BreakpointList } from "./breakpoints.ts";
import { ChartPanel } from "./chart-panel.ts";
import { Connection, type Connect, type Peer } from "./connection.ts";
import { Controls } from "./controls.ts";
import { Counterfactual } from "./counterfactual.ts";
import { Figures } from "./figures.ts";
import { Guards } from "./guards.ts";
import { Plot, type Subject } from "./plot.ts";
import type { GuardInfo, Hello, PageMessage, ServerMessage } from "./protocol.ts";
import { Run } from "./run.ts";
import { Scene } from "./scene.ts";
import { subjectsOf, subjects } from "./subjects.ts";
import type { Actions, Panel, View } from "./view.ts";

/** The least time (ms) between two pictures of new ticks. */
const PAUSE = 50;
/** The room (share of the duration) behind the shown tick, if it is not the newest one. */
const BEHIND = 0.4;

/** The live page: it receives messages and shows them in its panels. */
export class Page implements Actions {
  readonly #root: HTMLElement;
  /** Where controls and scene are shown. Above and among the other panels if undefined. */
  readonly #stage: HTMLElement | undefined;
  readonly #controls: Controls;
  readonly #connection: Peer;
  readonly #plots = element("div", "plots");
  #run: Run | undefined;
  #panels: Panel[] = [];
  #counterfactual: Counterfactual | undefined;
  #breakpoints: BreakpointList | undefined;
  #chart: ChartPanel | undefined;
  /** The shown tick. The newest one if undefined. */
  #selected: number | undefined;
  #duration = 20;
  #answer: Answer | undefined;
  #isScheduled = false;
  #timer: number | undefined;
  #shownAt = 0;

  constructor(root: HTMLElement, connect: Connect = (receive, change) => new Connection(receive, change), stage?: HTMLElement) {
    this.#stage = stage;
    this.#root = root;
    this.#controls = new Controls(this, () => this.#chart?.up(), stage === undefined ? "h1" : "h2");
    (stage ?? root).replaceChildren(this.#controls.element);
    this.#connection = connect(
      (message) => this.#receive(message),
      (isOpen) => this.#controls.report(isOpen ? "" : "Not connected. The page tries again every second."),
    );
  }

  send(message: PageMessage): void {
    this.#controls.report("");
    this.#connection.send(message);
  }

  select(tick: number | undefined): void {
    this.#selected = tick;
    this.refresh();
  }

  seek(time: number): void {
    this.select(this.#run?.history.nearest(time)?.tick);
  }

  zoomTime(duration: number): void {
    this.#duration = duration;
    this.refresh();
  }

  toggleBreakpoint(text: string): void {
    const isSet = this.#run?.breakpoints.some((breakpoint) => breakpoint.text === text) ?? false;
    this.send({ type: "break", add: isSet ? null : text, remove: isSet ? text : null });
  }

  compare(answer: Answer | undefined): void {
    this.#answer = answer;
    this.refresh();
  }

  /** Shows everything before the next picture of the screen. */
  refresh(): void {
    if (!this.#isScheduled) {
      this.#isScheduled = true;
      requestAnimationFrame(() => {
        this.#isScheduled = false;
        this.#shownAt = performance.now();
        this.#show();
      });
    }
  }

  #receive(message: ServerMessage): void {
    const run = this.#run;
    if (message.type === "hello") {
      this.#begin(message);
    } else if (message.type === "error") {
      if (!this.#counterfactual?.fault(message) && !this.#breakpoints?.fault(message)) {
        this.#controls.report(message.message);
      }
    } else if (run !== undefined) {
      switch (message.type) {
        case "ticks":
          // What a page has missed before it was opened was not lost.
          run.lost += run.history.last === undefined ? 0 : message.lost;
          run.add(message.frames);
          break;
        case "history": run.fill(message.frames); break;
        case "counterfactual": this.#counterfactual?.receive(message); break;
        case "status":
          run.status = message;
          if (message.state !== "running") {
            run.expect(message.ticks);
          }
          // Where a run stops is what the reader wants to see.
          if (message.state === "paused" && message.breakpoint !== null) {
            this.#selected = undefined;
          }
      }
      const range = run.request();
      if (range !== undefined) {
        this.#connection.send({ type: "range", from: range[0], to: range[1], most: null });
      }
    }
    if (message.type === "ticks" || message.type === "history") {
      this.#refreshSoon();
    } else {
      this.refresh();
    }
  }

  /** Shows new ticks, but not each one by itself. */
  #refreshSoon(): void {
    this.#timer ??= setTimeout(() => {
      this.#timer = undefined;
      this.refresh();
    }, Math.max(0, this.#shownAt + PAUSE - performance.now()));
  }

  /** Shows a new run. */
  #begin(hello: Hello): void {
    const run = new Run(hello);
    [this.#run, this.#selected, this.#answer] = [run, undefined, undefined];
    this.#chart = new ChartPanel(run, this);
    this.#counterfactual = new Counterfactual(run, this);
    const scene = new Scene(run, this);
    const guards = new Guards(run, this, (guard) => this.#plotGuard(guard));
    const figures = new Figures();
    const breakpoints = this.#breakpoints = new BreakpointList(run, this);
    this.#panels = [this.#controls, scene, this.#chart, guards, figures, breakpoints, this.#counterfactual];
    const { breakpoints: breaks, counterfactual, closed_loop: closedLoop } = hello.capabilities;
    breakpoints.element.hidden = !breaks && hello.command === "run";
    this.#counterfactual.element.hidden = !counterfactual && !closedLoop && hello.command === "run";
    this.#plots.replaceChildren();
    subjects(run).forEach((subject) => this.#plot(subject));
    const columns = [
      element("div", "column", ...(this.#stage === undefined ? [scene.element] : []), figures.element, breakpoints.element),
      element("div", "column", this.#chart.element, guards.element),
      element("div", "column", element("section", "", element("h2", "", "Plots"), this.#plots), this.#counterfactual.element),
    ];
    this.#stage?.replaceChildren(this.#controls.element, scene.element);
    this.#root.replaceChildren(...(this.#stage === undefined ? [this.#controls.element] : []), element("div", "panels", ...columns));
  }

  #plotGuard(guard: GuardInfo): void {
    for (const subject of subjectsOf(guard)) {
      if (!this.#panels.some((panel) => panel instanceof Plot && panel.subject.title === subject.title)) {
        const plot = this.#plot({ ...subject, close: () => this.#remove(plot) });
        plot.element.scrollIntoView({ block: "nearest" });
      }
    }
    this.refresh();
  }

  #plot(subject: Subject): Plot {
    const plot = new Plot(subject, this);
    this.#panels.push(plot);
    this.#plots.append(plot.element);
    return plot;
  }

  #remove(plot: Plot): void {
    this.#panels = this.#panels.filter((panel) => panel !== plot);
    plot.element.remove();
  }

  #show(): void {
    const run = this.#run;
    if (run === undefined) {
      return;
    }
    const { last } = run.history;
    const frame = this.#selected === undefined ? last : run.history.at(this.#selected);
    const [from, to] = this.#range(last?.time ?? 0, frame?.time ?? 0);
    const view: View = { run, frame, isFollowing: this.#selected === undefined, from, to, answer: this.#answer };
    this.#panels.forEach((panel) => panel.update(view));
  }

  /** The times (s) of the plots. */
  #range(end: number, shown: number): [number, number] {
    if (this.#duration === Infinity) {
      return [0, Math.max(end, 1)];
    }
    const to = Math.max(this.#duration, Math.min(end, shown + BEHIND * this.#duration));
    return [to - this.#duration, to];
  }
}
