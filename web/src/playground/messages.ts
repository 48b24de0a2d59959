import type { PageMessage, Point, ServerMessage } from "../live/protocol.ts";

/** A text of the program: a scenario or a policy. */
export interface BuiltIn {
  name: string;
  text: string;
}

/** A step that teaches the language, as `crates/playground/src/lessons.rs` defines it. */
export interface Lesson {
  title: string;
  text: string;
  task: string;
  scene: string;
  policy: string;
  solution: string;
  outcomes: string[];
  bounds: { figure: string; least?: number; most?: number }[];
}

/** What the program contains. */
export interface Catalog {
  version: string;
  scenarios: BuiltIn[];
  /** The policies that every run is compared with. */
  policies: BuiltIn[];
  /** The policies to begin from. */
  templates: BuiltIn[];
  families: { name: string; about: string }[];
  lessons: Lesson[];
  /** The words of the language by the scopes in which editors show them. */
  words: Record<string, string[]>;
}

/** The figures of a run that the page compares, by the keys of the JSON document of `run`. */
export interface Result {
  outcome: string;
  violations: string[];
  reason: string | null;
  scenario: string;
  policy: string;
  [key: string]: unknown;
}

/** A run that is to begin. */
export interface Start {
  scenario: string;
  policy: string;
  /** Other values (SI) of parameters. */
  set: Record<string, number>;
}

/** A drawn scene of a family. */
export interface Drawn {
  scenario: string;
  /** The speed (m/s) of its run. */
  speed: number;
}

/** An object of a scenario, as `crates/playground/src/shapes.rs` defines it. */
export interface Shape {
  kind: string;
  points: Point[];
  radius: number | null;
}

/** A change of an object of a scenario. */
export type Change =
  | { what: "move"; object: number; point: number; to: Point }
  | { what: "resize"; object: number; radius: number }
  | { what: "remove"; object: number }
  | { what: "disk"; centre: Point; radius: number }
  | { what: "polygon"; corners: Point[] };

/** A question that the machine answers at once. */
export type Question =
  | { type: "draw"; family: string; number: number }
  | { type: "shapes"; scenario: string }
  | { type: "reshape"; scenario: string; change: Change };

/** A message from the page to its worker. */
export type ToWorker =
  /** `run` is the number of the run, which is in the answers. */
  | { type: "start"; run: number; start: Start; speed: number }
  | { type: "stop" }
  | { type: "speed"; speed: number }
  | { type: "live"; message: PageMessage }
  | { type: "language"; message: unknown }
  | { type: "ask"; id: number; question: Question }
  | { type: "compare"; scenario: string; policies: string[]; set: Record<string, number> };

/** A message from the worker to its page. */
export type FromWorker =
  | { type: "ready"; catalog: Catalog }
  | { type: "live"; message: ServerMessage }
  /** Frames as a JSON text, which the page reads while the worker goes on. */
  | { type: "frames"; text: string }
  | { type: "language"; messages: LanguageMessage[] }
  | { type: "answered"; id: number; answer: unknown; error: string | undefined }
  | { type: "refused"; run: number; error: string }
  | { type: "scored"; run: number; result: Result; picture: string; realtime: number }
  | { type: "compared"; scenario: string; policy: string; result: Result | undefined }
  /** A message of the page has been answered as far as it is at once. */
  | { type: "taken" }
  | { type: "alive" }
  | { type: "broken"; error: string };

/** A message of the Language Server Protocol. */
export interface LanguageMessage {
  id?: number;
  method?: string;
  params?: unknown;
  result?: unknown;
  error?: { message: string };
}
