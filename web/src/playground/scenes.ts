import { button } from "../shared/button.ts";
import { element } from "../shared/element.ts";
import type { BuiltIn, Catalog, Drawn } from "./messages.ts";

/** The value of the choice for a scene that is none of the others. */
const OWN = "own";
/** How the value of a family begins. Names of scenes do not begin so. */
const FAMILY = "family ";

/** The choice of a scene: those of the program, and families from which one is drawn. */
export class Scenes {
  readonly element = element("span", "scenes");
  readonly #scenarios: readonly BuiltIn[];
  readonly #draw: (family: string, number: number) => Promise<Drawn | undefined>;
  readonly #chosen: (text: string, speed: number | undefined) => void;
  readonly #select = element("select");
  readonly #next: HTMLButtonElement;
  #number = 0;
  /** The drawn scene, and the value of its family. */
  #drawn = { value: "", text: "" };

  /** `draw` draws a scene of a family. `chosen` gets the text of a scenario, and the speed (m/s) that belongs to a drawn one. */
  constructor({ scenarios, families }: Catalog, draw: (family: string, number: number) => Promise<Drawn | undefined>, chosen: (text: string, speed: number | undefined) => void) {
    [this.#scenarios, this.#draw, this.#chosen] = [scenarios, draw, chosen];
    const isOfZoo = ({ name }: BuiltIn): boolean => name.includes("/");
    const option = ({ name }: BuiltIn): HTMLOptionElement => new Option(name.slice(name.indexOf("/") + 1), name);
    const group = (label: string, options: HTMLOptionElement[]): HTMLOptGroupElement => {
      const group = element("optgroup", "", ...options);
      group.label = label;
      return group;
    };
    this.#select.append(
      group("bench", scenarios.filter((scenario) => !isOfZoo(scenario)).map(option)),
      group("zoo", scenarios.filter(isOfZoo).map(option)),
      group("random", families.map(({ name, about }) => {
        // Some have the name of a scene.
        const option = new Option(`${name} (random)`, FAMILY + name);
        option.title = about;
        return option;
      })),
      new Option(OWN, OWN));
    this.#select.addEventListener("change", () => this.#choose());
    this.#next = button("another", () => void this.#take(this.#number + 1), "draw another scene of the family");
    this.#next.hidden = true;
    this.element.append(element("label", "", "scene ", this.#select), " ", element("span", "tools", this.#next));
  }

  /** The text of the scene with this name. */
  named(name: string): string | undefined {
    return this.#scenarios.find((scenario) => scenario.name === name)?.text;
  }

  /** Shows which scene a text is. */
  show(text: string): void {
    const known = this.#scenarios.find((scenario) => scenario.text === text)?.name;
    this.#select.value = known ?? (text === this.#drawn.text && text !== "" ? this.#drawn.value : OWN);
    this.#next.hidden = !this.#select.value.startsWith(FAMILY);
  }

  #choose(): void {
    if (this.#select.value.startsWith(FAMILY)) {
      void this.#take(0);
      return;
    }
    const text = this.named(this.#select.value);
    if (text !== undefined) {
      this.#chosen(text, undefined);
    }
  }

  async #take(number: number): Promise<void> {
    const { value } = this.#select;
    const drawn = await this.#draw(value.slice(FAMILY.length), number);
    // The reader may have chosen another one meanwhile.
    if (drawn !== undefined && this.#select.value === value) {
      [this.#number, this.#drawn] = [number, { value, text: drawn.scenario }];
      this.#chosen(drawn.scenario, drawn.speed);
    }
  }
}
