import type { Hello, TransitionInfo } from "./protocol.ts";

/** The state of a machine that has ended. */
export const ENDED = -1;

/** A state of the chart, or the whole machine, whose index is `ENDED`. */
export class Node {
  readonly index: number;
  readonly name: string;
  /** Its name without that of an outer state, which precedes it in the content of a behaviour. */
  readonly shortName: string;
  /** The state and its outer states, the outermost one first. The machine is not among them. */
  readonly path: readonly Node[];
  /** The names of its path. */
  readonly fullName: string;
  readonly behaviour: string | undefined;
  readonly parent: Node | undefined;
  readonly isInitial: boolean;
  readonly children: Node[] = [];
  /** The transitions that belong to it, not those of its inner states. */
  readonly transitions: TransitionInfo[] = [];

  constructor(index: number, name: string, behaviour: string | undefined, parent: Node | undefined, isInitial: boolean) {
    [this.index, this.name, this.behaviour, this.parent, this.isInitial] = [index, name, behaviour, parent, isInitial];
    parent?.children.push(this);
    this.path = parent === undefined ? [] : [...parent.path, this];
    const outer = parent?.path.find((node) => name.startsWith(`${node.name}.`));
    this.shortName = outer === undefined ? name : name.slice(outer.name.length + 1);
    this.fullName = this.path.map(({ shortName }) => shortName).join(" / ");
  }

  /** This state and all inner states, outer ones first. */
  all(): Node[] {
    return [this, ...this.children.flatMap((child) => child.all())];
  }
}

/** Where an arrow of a level ends: a state of the level, a state outside of it, or the end of the run. */
export type Target = Node | "Success" | "Failure";

/** An arrow of one level of the chart. */
export interface Arrow {
  from: Node;
  to: Target;
  transitions: TransitionInfo[];
}

/** The states of a policy. */
export class Chart {
  readonly root: Node;
  readonly nodes: readonly Node[];

  constructor(hello: Hello) {
    this.root = new Node(ENDED, hello.policy, undefined, undefined, true);
    const nodes: Node[] = [];
    hello.chart.states.forEach((state, index) => {
      const parent = (state.parent === null ? undefined : nodes[state.parent]) ?? this.root;
      nodes.push(new Node(index, state.name, state.behaviour ?? undefined, parent, state.initial));
    });
    for (const transition of hello.chart.transitions) {
      this.#owner(transition, nodes).transitions.push(transition);
    }
    this.nodes = nodes;
  }

  #owner({ state }: TransitionInfo, nodes: readonly Node[]): Node {
    return (state === null ? undefined : nodes[state]) ?? this.root;
  }

  /** The name of a state with those of its outer states. */
  name(state: number): string {
    return this.nodes[state]?.fullName ?? "ended";
  }

  target({ target, end }: TransitionInfo): Target {
    return (target === null ? undefined : this.nodes[target]) ?? (end === "success" ? "Success" : "Failure");
  }

  /**
   * The arrows between the inner states of a state, and from them to targets outside. A transition from the inside of one of them is one
   * of that state, unless it stays inside.
   */
  arrows(level: Node): Arrow[] {
    const arrows = new Map<string, Arrow>();
    for (const from of level.children) {
      for (const source of from.all()) {
        for (const transition of source.transitions) {
          const target = this.target(transition);
          const to = typeof target === "string" ? target : (level.children.find((child) => target.path.includes(child)) ?? target);
          if (to === from && source !== from) {
            continue;
          }
          const key = `${from.index} ${typeof to === "string" ? to : to.index}`;
          const arrow = arrows.get(key) ?? { from, to, transitions: [] };
          arrow.transitions.push(transition);
          arrows.set(key, arrow);
        }
      }
    }
    return [...arrows.values()];
  }
}
