/**
 * The messages of the protocol `vibrissa.live.v1`. `src/live/message.rs` defines them and says what each field means. All values are in SI
 * units and radians. States, whiskers and guards are named by their indices in `Hello`.
 */

export type Point = [x: number, y: number];
export type Pose = [x: number, y: number, heading: number];

export type ServerMessage = Hello | Ticks | Status | Past | Piece | Fault;

export interface Hello {
  type: "hello";
  protocol: string;
  version: string;
  run: number;
  command: "run" | "replay" | "drive";
  scenario: string;
  policy: string;
  world: string | null;
  duration: number | null;
  known_ticks: number | null;
  control_period: number;
  dt: number;
  capabilities: { step: boolean; breakpoints: boolean; counterfactual: boolean; closed_loop: boolean };
  whiskers: string[];
  guards: GuardInfo[];
  no_guards: string | null;
  chart: { states: StateInfo[]; transitions: TransitionInfo[] };
  parameters: ParameterInfo[];
  scene: Outline[] | null;
  rig: { platform: Point[]; whiskers: { base: Point; direction: number; length: number; threshold: number }[] };
  start: Pose | null;
  plots: PlotInfo[];
  breakpoints: BreakpointInfo[];
}

export interface PlotInfo {
  name: string;
  unit: string;
  choices: string[];
}

export interface GuardInfo {
  index: number;
  state: number | null;
  target: string;
  text: string;
  file: string | null;
  line: number;
  parts: { text: string; unit: string | null }[];
}

export interface StateInfo {
  name: string;
  parent: number | null;
  initial: boolean;
  behaviour: string | null;
}

export interface TransitionInfo {
  state: number | null;
  target: number | null;
  end: "success" | "failure" | null;
  guard: number | null;
  text: string;
}

export interface ParameterInfo {
  name: string;
  value: number;
  unit: string;
  low: number | null;
  high: number | null;
  choices: string[];
  meaning: string;
  guard: number | null;
}

export interface Outline {
  points: Point[];
  closed: boolean;
}

export interface BreakpointInfo {
  text: string;
  state: number | null;
}

export interface Ticks {
  type: "ticks";
  lost: number;
  frames: Frame[];
}

export interface Frame {
  tick: number;
  time: number;
  states: number[];
  pose: Pose;
  whiskers: WhiskerFrame[];
  guards: GuardFrame[];
  taken: number[];
  command: [x: number, y: number, yawRate: number];
  contour: ContourFrame[];
  metrics: Metrics;
  loop: { period: number | null; used: number; overload: boolean } | null;
  messages: string[];
  plots: (number | null)[];
  map: MapFrame | null;
}

export interface MapFrame {
  cell: number;
  origin: Point;
  free: CellSpan[];
  blocked: CellSpan[];
  route: Point[];
  target: Point | null;
}

export type CellSpan = [row: number, from: number, to: number];

export interface Metrics {
  error: number | null;
  coverage: number | null;
  spread: number | null;
}

export interface WhiskerFrame {
  base_angle: number;
  touching: boolean;
  shaft: Point[];
  tip: Point | null;
}

export interface GuardFrame {
  guard: number;
  met: boolean;
  margins: (number | null)[];
  missing: number[];
  elapsed: number | null;
  needed: number | null;
}

export interface ContourFrame {
  whisker: number;
  point: Point;
  spread: number | null;
  error: number | null;
}

export interface Status {
  type: "status";
  state: "running" | "paused" | "finished";
  reason: string | null;
  breakpoint: string | null;
  verdict: string | null;
  metrics: Metrics | null;
  ticks: number;
  kept_every: number;
  breakpoints: BreakpointInfo[];
}

export interface Past {
  type: "history";
  from: number;
  to: number;
  frames: Frame[];
}

export type Kind = "recorded" | "closed_loop";

export interface Piece {
  type: "counterfactual";
  id: number;
  kind: Kind;
  frames: PieceFrame[];
  first_difference: FirstDifference | null;
  done: boolean;
  end: string | null;
}

export interface PieceFrame {
  tick: number;
  time: number;
  states: number[];
  pose: Pose | null;
  contour: Point[];
}

export interface FirstDifference {
  tick: number;
  time: number;
  states_differ: boolean;
  before: string;
  after: string;
}

export interface Fault {
  type: "error";
  message: string;
  id: number | null;
}

export type PageMessage =
  | { type: "pause" }
  | { type: "run" }
  | { type: "step"; ticks: number }
  | { type: "range"; from: number; to: number; most: number | null }
  | { type: "break"; add: string | null; remove: string | null }
  | { type: "counterfactual"; id: number; tick: number; kind: Kind; set: Record<string, number> }
  | { type: "cancel"; id: number };
