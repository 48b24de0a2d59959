/** The functions of the module, as `crates/playground/src/export.rs` defines them. */
interface Exports {
  memory: WebAssembly.Memory;
  reserve(length: number): number;
  answer(): number;
  answered(): number;
}

/** The compiler, the language server and the simulator, as WebAssembly. Both sides exchange JSON texts in its memory. */
export class Machine {
  readonly #exports: Exports;

  private constructor(exports: Exports) {
    this.#exports = exports;
  }

  static async load(address: URL | string): Promise<Machine> {
    const response = await fetch(address);
    if (!response.ok) {
      throw new Error(`${response.url} cannot be loaded (${response.status})`);
    }
    // Not every static host knows the type that streaming needs.
    const { instance } = await WebAssembly.instantiate(await response.arrayBuffer());
    return new Machine(instance.exports as unknown as Exports);
  }

  /** The answer to a request, as a JSON text. */
  text(request: object): string {
    const bytes = new TextEncoder().encode(JSON.stringify(request));
    const { memory, reserve, answer, answered } = this.#exports;
    // The memory has another buffer after it has grown, so each address comes first.
    const address = reserve(bytes.length);
    new Uint8Array(memory.buffer, address, bytes.length).set(bytes);
    const length = answer();
    return new TextDecoder().decode(new Uint8Array(memory.buffer, answered(), length));
  }

  /** Answers a request. A fault of the request is an exception. */
  ask<Answer>(request: object): Answer {
    const value = JSON.parse(this.text(request)) as Answer & { error?: string };
    if (value !== null && typeof value === "object" && typeof value.error === "string") {
      throw new Refusal(value.error);
    }
    return value;
  }
}

/** The machine refuses a request, and says why. */
export class Refusal extends Error {}
