import { button } from "../shared/button.ts";
import { element } from "../shared/element.ts";
import { shortfalls } from "./figures.ts";
import type { Lesson, Result } from "./messages.ts";

/** The steps that teach the language. One of them is shown, or none. */
export class Lessons {
  readonly element = element("section", "lessons");
  readonly #lessons: readonly Lesson[];
  readonly #open: (policy: string, scene: string) => void;
  readonly #started = element("div", "tools");
  readonly #body = element("div");
  readonly #verdict = element("p", "lesson-verdict");
  readonly #steps: HTMLButtonElement[];
  readonly #done = new Set<Lesson>();
  #shown: Lesson | undefined;

  /** `open` shows the policy of a step in its scene and runs it. */
  constructor(lessons: readonly Lesson[], open: (policy: string, scene: string) => void) {
    [this.#lessons, this.#open] = [lessons, open];
    this.#steps = lessons.map((lesson, index) => button(String(index + 1), () => this.#show(this.#shown === lesson ? undefined : lesson), `${index + 1}: ${lesson.title}`));
    this.#verdict.setAttribute("role", "status");
    this.element.append(element("div", "head", element("h2", "", "Learn the language"), element("div", "tools", ...this.#steps)), this.#body);
    const first = button("Start with step 1", () => this.#show(lessons[0]));
    first.className = "primary";
    this.#started.append(first);
    this.#show(undefined);
  }

  /** Checks the task of the shown step after a run. `isOfReader` is true if the reader has changed something or has started the run. */
  check(result: Result, isOfReader: boolean): void {
    const lesson = this.#shown;
    if (lesson === undefined) {
      return;
    }
    const missing = [...(result.scenario === lesson.scene ? [] : [`the scene has to be ${lesson.scene}`]), ...shortfalls(result, lesson.bounds)];
    const ended = `the outcome is ${result.outcome}${result.reason === null ? "" : ` (${result.reason})`}`;
    // Also where any outcome will do, a failure is often the cause of the rest.
    const causes = lesson.outcomes.includes(result.outcome) && result.outcome !== "failed" ? missing : [ended, ...missing];
    const isDone = missing.length === 0 && lesson.outcomes.includes(result.outcome);
    if (isDone) {
      this.#done.add(lesson);
    }
    // That the policy with which a step begins does not do the task is no fault of the reader.
    this.#verdict.textContent = isDone ? "Done." : isOfReader ? `Not yet: ${causes.join("; ")}.` : "";
    this.#verdict.classList.toggle("done", isDone);
    this.#mark();
  }

  /** Forgets the verdict: a run begins, or its text is another one now. */
  forget(): void {
    this.#verdict.textContent = "";
    this.#verdict.classList.remove("done");
  }

  #show(lesson: Lesson | undefined): void {
    this.#shown = lesson;
    this.forget();
    this.#body.replaceChildren();
    this.#mark();
    if (lesson === undefined) {
      this.#body.append(this.#started);
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
