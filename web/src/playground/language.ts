import type { LanguageMessage } from "./messages.ts";

/** The time (ms) after the last change of a text before it is analysed. */
const PAUSE = 150;

/** The document of the policy in the language server. */
export const DOCUMENT = "file:///policy.fsm";

export interface Position {
  line: number;
  character: number;
}

export interface Range {
  start: Position;
  end: Position;
}

export interface Problem {
  range: Range;
  severity?: number;
  code?: string | number;
  message: string;
}

export interface Proposal {
  label: string;
  detail?: string;
  documentation?: string | { value: string };
  insertText?: string;
  textEdit?: { newText: string; range: Range };
}

/** The client of the language server in the worker. */
export class Language {
  readonly #send: (message: unknown) => void;
  readonly #show: (problems: Problem[], version: number) => void;
  readonly #waiting = new Map<number, (answer: unknown) => void>();
  #next = 1;
  #version = 0;
  #changed: string | undefined;
  #timer: number | undefined;

  constructor(send: (message: unknown) => void, show: (problems: Problem[], version: number) => void) {
    [this.#send, this.#show] = [send, show];
  }

  /** The version of the text that was sent last. */
  get version(): number {
    return this.#version;
  }

  /** Begins with a text, also in a new worker. */
  open(text: string): void {
    this.close();
    void this.#ask("initialize", { processId: null, rootUri: null, capabilities: {} });
    this.#tell("textDocument/didOpen", { textDocument: { uri: DOCUMENT, languageId: "fsm", version: (this.#version += 1), text } });
  }

  /** Answers all questions with nothing, and forgets a change: nobody is there to be asked. */
  close(): void {
    this.#waiting.forEach((resolve) => resolve(null));
    this.#waiting.clear();
    clearTimeout(this.#timer);
    this.#changed = undefined;
  }

  /** Sends a changed text, as soon as it has not changed for a while or a question needs it. */
  change(text: string): void {
    this.#version += 1;
    this.#changed = text;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#flush(), PAUSE);
  }

  #flush(): void {
    clearTimeout(this.#timer);
    if (this.#changed !== undefined) {
      this.#tell("textDocument/didChange", { textDocument: { uri: DOCUMENT, version: this.#version }, contentChanges: [{ text: this.#changed }] });
      this.#changed = undefined;
    }
  }

  async hover(position: Position): Promise<string | undefined> {
    const answer = (await this.#ask("textDocument/hover", { textDocument: { uri: DOCUMENT }, position })) as { contents: { value: string } } | null;
    return answer?.contents.value;
  }

  async complete(position: Position): Promise<Proposal[]> {
    const answer = (await this.#ask("textDocument/completion", { textDocument: { uri: DOCUMENT }, position })) as Proposal[] | { items: Proposal[] } | null;
    return answer === null ? [] : Array.isArray(answer) ? answer : answer.items;
  }

  async format(): Promise<{ range: Range; newText: string }[]> {
    const options = { tabSize: 2, insertSpaces: true };
    return ((await this.#ask("textDocument/formatting", { textDocument: { uri: DOCUMENT }, options })) as { range: Range; newText: string }[] | null) ?? [];
  }

  receive(messages: readonly LanguageMessage[]): void {
    for (const { id, method, params, result } of messages) {
      if (method === "textDocument/publishDiagnostics") {
        const { diagnostics, version } = params as { diagnostics: Problem[]; version?: number };
        this.#show(diagnostics, version ?? this.#version);
      } else if (id !== undefined) {
        this.#waiting.get(id)?.(result ?? null);
        this.#waiting.delete(id);
      }
    }
  }

  #ask(method: string, params: unknown): Promise<unknown> {
    this.#flush();
    const id = this.#next++;
    this.#send({ jsonrpc: "2.0", id, method, params });
    return new Promise((resolve) => this.#waiting.set(id, resolve));
  }

  #tell(method: string, params: unknown): void {
    this.#send({ jsonrpc: "2.0", method, params });
  }
}
