import type { Peer } from "../live/connection.ts";
import { Page } from "../live/page.ts";
import type { Hello, ServerMessage } from "../live/protocol.ts";
import { button } from "../shared/button.ts";
import { download, fileName } from "../shared/download.ts";
import { element } from "../shared/element.ts";
import { Editor, services } from "./editor.ts";
import { Language, type Problem } from "./language.ts";
import { keep, restored } from "./kept.ts";
import { Lessons } from "./lessons.ts";
import { decode, encode } from "./link.ts";
import type { BuiltIn, Catalog, Change, Drawn, FromWorker, Question, Result, Shape, Start } from "./messages.ts";
import { Parameters } from "./parameters.ts";
import { Scenes } from "./scenes.ts";
import { Score } from "./score.ts";
import { Shapes } from "./shapes.ts";
import { Simulator } from "./simulator.ts";
import { policySyntax, scenarioSyntax } from "./syntax.ts";

/** The ratios of simulated time to wall time. */
const SPEEDS: readonly [speed: number, name: string][] = [[1, "real time"], [5, "5 times"], [20, "20 times"], [Infinity, "as fast as possible"]];
/** The time (ms) after the last change of a slider or of a shape before the run begins again. */
const PAUSE = 150;
/** The largest number of listed diagnostics. */
const LISTED = 20;

/** A run that was asked for. */
interface Running {
  number: number;
  start: Start;
  /** True if the reader has started it or has changed something. */
  isOfReader: boolean;
}

/** The playground: editors, the run, and its score. */
export class Playground {
  readonly #root: HTMLElement;
  readonly #loading: Element | null;
  readonly #simulator: Simulator;
  readonly #language: Language;
  readonly #parameters = new Parameters(() => this.#runSoon());
  readonly #score = new Score();
  readonly #template = element("select");
  readonly #speed = element("select");
  readonly #fault = element("pre", "fault");
  readonly #notice = element("p", "notice");
  readonly #problems = element("p", "hint problems");
  readonly #listed = element("ul", "listed");
  readonly #details = element("details");
  readonly #saves = element("div", "tools");
  readonly #results = [button("result", () => this.#save("json"), "download the result as JSON"), button("picture", () => this.#save("svg"), "download the picture of the run")];
  readonly #outdated = element("span", "hint", "Result and picture are from the previous text. Run the present one to save them.");
  readonly #run: HTMLButtonElement;
  readonly #shapes = new Shapes((change) => this.#reshape(change), (isAgain) => {
    this.#scenario?.undo(isAgain);
    this.#runSoon();
  });
  /** The policy that the reader has written last. */
  #own: string | undefined;
  #lessons: Lessons | undefined;
  #scenes: Scenes | undefined;
  #catalog: Catalog | undefined;
  #policy: Editor | undefined;
  #scenario: Editor | undefined;
  #receive: (message: ServerMessage) => void = () => undefined;
  #compared = "";
  /** The speed (m/s) that belongs to a drawn scene. */
  #drawn: { speed?: number } = {};
  /** The newest run. Answers of earlier ones come too late. */
  #running: Running = { number: 0, start: { policy: "", scenario: "", set: {} }, isOfReader: false };
  #last: { result: Result; picture: string; start: Start } | undefined;
  #timer: number | undefined;
  /** True if the page shows a run. */
  #hasBegun = false;

  constructor(root: HTMLElement) {
    [this.#root, this.#loading] = [root, root.querySelector(".loading")];
    this.#language = new Language(
      (message) => this.#simulator.send({ type: "language", message }),
      (problems, version) => {
        if (version === this.#language.version) {
          this.#policy?.show(problems);
          const errors = problems.filter(({ severity }) => severity === 1).length;
          this.#problems.textContent = problems.length === 0 ? "no errors, no warnings" : `${count(errors, "error")}, ${count(problems.length - errors, "warning")}`;
          this.#list(problems);
        }
      },
    );
    this.#run = button("run", () => this.#start(), "simulate the policy in the scene (Ctrl+Enter)");
    this.#simulator = new Simulator((message) => this.#hear(message), () => this.#language.open(this.#policy?.text ?? ""), (reason) => {
      this.#tell(reason);
      this.#language.close();
      this.#receive({ type: "status", state: "finished", reason, breakpoint: null, verdict: "stopped", metrics: null, ticks: 0, kept_every: 1, breakpoints: [] });
    });
  }

  /** Lists diagnostics below the editor. */
  #list(problems: readonly Problem[]): void {
    const items = problems.slice(0, LISTED).map(({ range, severity, message }) => element("li", severity === 1 ? "error" : "", `${severity === 1 ? "error" : "warning"} in line ${range.start.line + 1}: ${message}`));
    if (problems.length > LISTED) {
      items.push(element("li", "", `${problems.length - LISTED} more`));
    }
    this.#listed.replaceChildren(...items);
  }

  #hear(message: FromWorker): void {
    switch (message.type) {
      case "ready":
        if (this.#catalog === undefined) {
          this.#catalog = message.catalog;
          void this.#build(message.catalog);
        }
        break;
      case "live":
        if (message.message.type === "hello") {
          this.#begin(message.message);
        }
        this.#receive(message.message);
        break;
      case "language": this.#language.receive(message.messages); break;
      case "refused":
        if (message.run === this.#running.number) {
          this.#refuse(message.error);
        }
        break;
      case "scored":
        if (message.run === this.#running.number) {
          this.#finish(message.result, message.picture, message.realtime);
        }
        break;
      case "compared":
        if (message.scenario === this.#compared) {
          this.#score.other(message.policy, message.result);
        }
        break;
      case "taken":
      case "alive":
      case "broken":
      case "answered":
    }
  }

  /** Builds the page, as soon as the machine is there. */
  async #build(catalog: Catalog): Promise<void> {
    const { scenarios, policies, templates: known, words } = catalog;
    const scene = element("div", "stage");
    const choose = (select: HTMLSelectElement, label: string, names: readonly string[], changed: () => void): HTMLElement => {
      select.append(...names.map((name, index) => new Option(name, String(index))));
      select.addEventListener("change", changed);
      return element("label", "", `${label} `, select);
    };
    const draw = async (family: string, number: number): Promise<Drawn | undefined> => (await this.#ask({ type: "draw", family, number })) as Drawn | undefined;
    const scenes = this.#scenes = new Scenes(catalog, draw, (text, speed) => this.#chooseScene(text, speed));
    const templates = choose(this.#template, "policy", [...known.map(({ name }) => name), "own"], () => this.#chooseTemplate());
    const speeds = choose(this.#speed, "speed", SPEEDS.map(([, name]) => name), () => this.#simulator.send({ type: "speed", speed: this.#pace() }));
    this.#speed.value = "2";
    this.#run.className = "primary";
    const tools = element("div", "tools",
      this.#run,
      button("stop", () => this.#simulator.send({ type: "stop" }), "end the run"),
      button("format", () => void this.#policy?.format(this.#language), "format the policy"),
      button("copy link", () => void this.#share(), "copy a link that holds policy, scenario and parameters"));
    this.#saves.append(
      button("policy", () => this.#save("fsm"), "download the policy"), button("scenario", () => this.#save("yaml"), "download the scenario"),
      ...this.#results, this.#outdated);
    this.#outdated.hidden = true;
    this.#saves.hidden = true;
    this.#saves.prepend(element("span", "hint", "Download:"));
    this.#fault.setAttribute("role", "alert");
    this.#notice.setAttribute("role", "status");
    const policyBox = element("div", "editor");
    const scenarioBox = element("div", "editor");
    this.#lessons = new Lessons(catalog.lessons ?? [], (policy, scene) => {
      this.#load(policy, scenes.named(scene) ?? "");
      this.#start(false);
    });
    this.#details.append(element("summary", "", "Scenario"), scenarioBox);
    this.#shapes.element.addEventListener("toggle", () => void this.#showShapes());
    const live = element("div", "live");
    const left = element("div", "column write", this.#lessons.element, element("section", "", element("div", "head", element("h2", "", "Policy"), this.#problems), policyBox), this.#listed, this.#fault, this.#shapes.element, this.#details, this.#parameters.element);
    const right = element("div", "column", scene, this.#score.element, this.#saves);
    // The introduction is part of the document, so that there is something to read before the module is there.
    this.#loading?.remove();
    this.#root.append(
      element("header", "bar", element("div", "choices", scenes.element, templates, speeds), tools, this.#notice),
      element("div", "bench", left, right), live);
    this.#policy = new Editor(policyBox, "policy", (text, isOfReader) => {
      this.#own = isOfReader ? text : this.#own;
      this.#keep(isOfReader);
      if (this.#catalog?.templates[Number(this.#template.value)]?.text !== text) {
        this.#template.value = String(known.length);
      }
      this.#language.change(text);
      this.#date();
    }, [policySyntax(words), ...services(this.#language)]);
    this.#scenario = new Editor(scenarioBox, "scenario", (text, isOfReader) => {
      this.#keep(isOfReader);
      scenes.show(text);
      void this.#showShapes();
      this.#date();
    }, [scenarioSyntax()]);
    this.#language.open("");
    new Page(live, (receive): Peer => {
      this.#receive = receive;
      return { send: (message) => this.#simulator.send({ type: "live", message }) };
    }, scene);
    addEventListener("keydown", (event) => {
      if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) {
        event.preventDefault();
        this.#start();
      }
    }, true);
    addEventListener("hashchange", () => void this.#openLink().then((isOpen) => isOpen || this.#refuseLink()));
    if (!(await this.#openLink())) {
      const kept = restored();
      this.#own = kept?.policy;
      this.#load(kept?.policy ?? policies[0]?.text ?? "", kept?.scenario ?? scenarios[0]?.text ?? "");
      this.#start(false);
      if (kept) {
        this.#tell("This is your policy of the last visit. The list of policies has the others.");
      }
      this.#refuseLink();
    }
  }

  /** Shows why a run cannot begin, below the text that is wrong. */
  #refuse(error: string): void {
    this.#fault.textContent = error;
    const isScenario = error.includes("scenario.yaml");
    (isScenario ? this.#details : this.#listed).after(this.#fault);
    this.#details.open ||= isScenario;
    if (this.#hasBegun) {
      this.#tell("This run cannot begin. What you see is still the one before.");
    }
  }

  /** Runs what the link of the page holds. False if it holds nothing that can be read. */
  async #openLink(): Promise<boolean> {
    const link = location.hash;
    const shared = link === "" ? undefined : await decode(link);
    if (shared === undefined) {
      return false;
    }
    this.#load(shared.policy, shared.scenario ?? this.#catalog?.scenarios[0]?.text ?? "");
    this.#parameters.take(shared.set);
    this.#start();
    return true;
  }

  #refuseLink(): void {
    if (location.hash !== "") {
      this.#tell("The link holds no policy that this page can read.");
    }
  }

  /** Shows texts. */
  #load(policy: string, scenario: string): void {
    if (this.#policy && this.#scenario && this.#catalog) {
      const place = (texts: readonly BuiltIn[], text: string): string => {
        const index = texts.findIndex((known) => known.text === text);
        return String(index < 0 ? texts.length : index);
      };
      this.#template.value = place(this.#catalog.templates, policy);
      this.#drawn = {};
      this.#parameters.take({});
      this.#policy.text = policy;
      this.#scenario.text = scenario;
      this.#scenes?.show(scenario);
    }
  }

  /** Shows a scene, and runs the policy in it. */
  #chooseScene(text: string, speed: number | undefined): void {
    if (this.#scenario) {
      this.#scenario.text = text;
      this.#scenes?.show(text);
      const { speed: own, ...others } = this.#parameters.set;
      const kept = own === undefined || own === this.#drawn.speed ? others : { ...others, speed: own };
      this.#drawn = speed !== undefined && this.#parameters.has("speed") ? { speed } : {};
      this.#parameters.take({ ...kept, ...this.#drawn });
      this.#start();
    }
  }

  /** Asks the machine. What is wrong is told, and has no answer. */
  async #ask(question: Question): Promise<unknown> {
    try {
      return await this.#simulator.ask(question);
    } catch (fault) {
      this.#tell(fault instanceof Error ? fault.message : String(fault));
      return undefined;
    }
  }

  /** Changes an object of the scenario, and runs the policy in it. */
  async #reshape(change: Change): Promise<void> {
    const changed = (await this.#ask({ type: "reshape", scenario: this.#scenario?.text ?? "", change })) as { scenario: string } | undefined;
    if (changed && this.#scenario) {
      this.#scenario.text = changed.scenario;
      this.#runSoon();
    }
  }

  /** Shows the objects of the text of the scenario, while somebody sees them. */
  async #showShapes(): Promise<void> {
    const text = this.#scenario?.text ?? "";
    if (this.#shapes.element.open) {
      // A text that is being written is not always a scenario.
      const shapes = (await this.#simulator.ask({ type: "shapes", scenario: text }).catch(() => undefined)) as Shape[] | undefined;
      if (shapes && this.#scenario?.text === text) {
        this.#shapes.show(shapes);
      }
    }
  }

  #chooseTemplate(): void {
    const text = this.#catalog?.templates[Number(this.#template.value)]?.text ?? this.#own;
    if (text !== undefined && this.#policy) {
      this.#parameters.take({});
      this.#policy.text = text;
      this.#start();
    }
  }

  /** Keeps the texts in this browser, after a change of the reader. */
  #keep(isOfReader: boolean): void {
    if (isOfReader && this.#own !== undefined) {
      keep({ policy: this.#own, scenario: this.#scenario?.text ?? "" });
    }
  }

  #pace(): number {
    return SPEEDS[Number(this.#speed.value)]?.[0] ?? Infinity;
  }

  #texts(): Start {
    return { policy: this.#policy?.text ?? "", scenario: this.#scenario?.text ?? "", set: { ...this.#parameters.set } };
  }

  #runSoon(): void {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#start(), PAUSE);
  }

  #start(isOfReader = true): void {
    clearTimeout(this.#timer);
    const [number, start] = [this.#running.number + 1, this.#texts()];
    this.#running = { number, start, isOfReader };
    this.#fault.textContent = "";
    this.#tell("");
    this.#lessons?.forget();
    this.#date();
    this.#simulator.send({ type: "start", run: number, start, speed: this.#pace() });
  }

  /** Shows the end of the newest run. */
  #finish(result: Result, picture: string, realtime: number): void {
    const { start, isOfReader } = this.#running;
    this.#last = { result, picture, start };
    this.#saves.hidden = false;
    this.#score.own(result, realtime);
    this.#date();
    // A text that was changed during its run has no verdict.
    if (isSame(start, this.#texts())) {
      this.#lessons?.check(result, isOfReader);
    }
    this.#compare();
  }

  /** Tells whether the last result is one of the present texts. Only then it can be saved. */
  #date(): void {
    const isPast = this.#last !== undefined && !isSame(this.#last.start, this.#texts());
    this.#score.date(isPast);
    this.#results.forEach((save) => { save.disabled = isPast; });
    this.#outdated.hidden = !isPast;
    if (isPast) {
      this.#lessons?.forget();
    }
  }

  #begin(hello: Hello): void {
    this.#hasBegun = true;
    this.#shapes.begin(hello);
    this.#parameters.show(hello.parameters.filter(({ guard }) => guard === null));
    if (this.#compared !== this.#running.start.scenario) {
      this.#score.clear();
    }
  }

  /** Runs the policies of the program in the scene, unless their figures are there already. */
  #compare(): void {
    this.#compared = this.#running.start.scenario;
    const missing = (this.#catalog?.policies ?? []).map(({ name }) => name).filter((name) => !this.#score.has(name));
    if (missing.length > 0) {
      this.#simulator.send({ type: "compare", scenario: this.#compared, policies: missing, set: { ...this.#drawn } });
    }
  }

  async #share(): Promise<void> {
    history.replaceState(null, "", await encode(this.#texts()));
    try {
      await navigator.clipboard.writeText(location.href);
      this.#tell("The link is copied. It holds policy, scenario and parameters.");
    } catch {
      this.#tell("The link is in the address bar. It holds policy, scenario and parameters.");
    }
  }

  #save(extension: "fsm" | "yaml" | "json" | "svg"): void {
    const { policy, scenario } = this.#texts();
    const { result, picture } = this.#last ?? {};
    const contents = { fsm: policy, yaml: scenario, json: JSON.stringify({ ...result, set: this.#last?.start.set }, null, 2), svg: picture ?? "" };
    const types = { fsm: "text/plain", yaml: "text/plain", json: "application/json", svg: "image/svg+xml" };
    // The reader may have changed the text since the run.
    const name = (extension === "yaml" ? /^name:\s*(.+)$/m.exec(scenario) : /^\s*machine\s+(\w+)/m.exec(policy))?.[1];
    download(fileName(name ?? (extension === "yaml" ? "scenario" : "policy"), extension), types[extension], contents[extension]);
  }

  #tell(text: string): void {
    this.#notice.textContent = text;
    if (this.#catalog === undefined && this.#loading !== null) {
      this.#loading.textContent = text;
    }
  }
}

/** True if two runs have the same texts and values, and therefore the same result. */
function isSame(a: Start, b: Start): boolean {
  return a.policy === b.policy && a.scenario === b.scenario && JSON.stringify(a.set) === JSON.stringify(b.set);
}

function count(number: number, noun: string): string {
  return `${number} ${noun}${number === 1 ? "" : "s"}`;
}
