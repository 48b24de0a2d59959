import { button } from "../shared/button.ts";
import { element } from "../shared/element.ts";
import type { Lesson, Result } from "./messages.ts";
import { figure } from "./score.ts";

/** The steps that teach the language. One of them is shown, or none. */
export class Lessons {
  readonly element = element("section", "lessons");
  readonly #lessons: readonly Lesson[];
  readonly #open: (policy: string, scene: string) => void;
  readonly #body = element("div");
  readonly #verdict = element("p", "lesson-verdict");
  readonly #steps: HTMLButtonElement[];
  readonly #done = new Set<Lesson>();
  #shown: Lesson | undefined;

  /** `open` shows the policy of a step in its scene. */
  constructor(lessons: readonly Lesson[], open: (policy: string, scene: string) => void) {
    [this.#lessons, this.#open] = [lessons, open];
    this.#steps = lessons.map((lesson, index) => button(String(index + 1), () => this.#show(this.#shown === lesson ? undefined : lesson), `step ${index + 1}: ${lesson.title}`));
    this.#verdict.setAttribute("role", "status");
    this.element.append(element("div", "head", element("h2", "", "Learn the language"), element("div", "tools", ...this.#steps)), this.#body);
    this.#mark();
  }

  /** Checks the task of the shown step after a run. */
  check(result: Result): void {
    const lesson = this.#shown;
    if (lesson === undefined) {
      return;
    }
    const missing = lesson.bounds.find(({ figure: path, least, most }) => {
      const value = figure(result, path);
      return typeof value !== "number" || value < (least ?? -Infinity) || value > (most ?? Infinity);
    });
    const isDone = missing === undefined && lesson.outcomes.includes(result.outcome);
    if (isDone) {
      this.#done.add(lesson);
    }
    const bound = missing === undefined ? "" : `: ${missing.figure} has to be ${missing.least === undefined ? `at most ${missing.most}` : `at least ${missing.least}`}`;
    this.#verdict.textContent = isDone ? "Done." : `Not yet${bound || `: the run is ${result.outcome}`}.`;
    this.#verdict.classList.toggle("done", isDone);
    this.#mark();
  }

  #show(lesson: Lesson | undefined): void {
    this.#shown = lesson;
    this.#verdict.textContent = "";
    this.#verdict.classList.remove("done");
    this.#body.replaceChildren();
    this.#mark();
    if (lesson === undefined) {
      return;
    }
    const next = this.#lessons[this.#lessons.indexOf(lesson) + 1];
    const tools = element("div", "tools",
      button("begin again", () => this.#open(lesson.policy, lesson.scene), "show the policy with which the step begins"),
      button("solution", () => this.#open(lesson.solution, lesson.scene), "show a policy that does it"));
    if (next) {
      tools.append(button("next step", () => this.#show(next)));
    }
    this.#body.append(element("h3", "", lesson.title), element("p", "", ...coded(lesson.text)), element("p", "task", ...coded(lesson.task)), this.#verdict, tools);
    this.#open(lesson.policy, lesson.scene);
  }

  #mark(): void {
    this.#lessons.forEach((lesson, index) => {
      const step = this.#steps[index];
      step?.setAttribute("aria-pressed", String(this.#shown === lesson));
      if (step) {
        step.textContent = `${index + 1}${this.#done.has(lesson) ? " ✓" : ""}`;
      }
    });
  }
}

/** A text whose parts between grave accents are code. */
function coded(text: string): (string | HTMLElement)[] {
  return text.split("`").map((part, index) => (index % 2 === 1 ? element("code", "", part) : part));
}
