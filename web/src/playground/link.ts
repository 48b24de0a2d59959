import type { Start } from "./messages.ts";

/** The longest text of a link (characters), as for a file of the program. */
const LIMIT = 1 << 20;
/** The largest number of parameters in a link. */
const MOST_PARAMETERS = 200;

/** How the fragment of a link begins that holds a policy alone, as the book writes it. */
const POLICY = "#policy=";

/** What a link holds. A link from the book has no scenario. */
export type Shared = Omit<Start, "scenario"> & { scenario: string | undefined };

/** The fragment of a link: JSON, compressed, in the alphabet of URLs. */
export async function encode(shared: Start): Promise<string> {
  const bytes = await whole(new Blob([JSON.stringify(shared)]).stream().pipeThrough(new CompressionStream("deflate-raw")), Infinity);
  let text = "";
  for (const byte of bytes) {
    text += String.fromCharCode(byte);
  }
  return `#1${btoa(text).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "")}`;
}

/** What a fragment holds. Undefined if it is not one of this page, or a damaged one: nothing in a link is trusted. */
export async function decode(fragment: string): Promise<Shared | undefined> {
  if (fragment.length > LIMIT) {
    return undefined;
  }
  try {
    if (fragment.startsWith(POLICY)) {
      return { scenario: undefined, policy: decodeURIComponent(fragment.slice(POLICY.length)), set: {} };
    }
    if (!fragment.startsWith("#1")) {
      return undefined;
    }
    const text = atob(fragment.slice(2).replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
    const raw = await whole(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw")), LIMIT);
    return checked(JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(raw)));
  } catch {
    return undefined;
  }
}

/** The bytes of a stream. More than `most` are an error, so that a small link does not fill the memory. */
async function whole(stream: ReadableStream<Uint8Array>, most: number): Promise<Uint8Array> {
  const parts: Uint8Array[] = [];
  let length = 0;
  const reader = stream.getReader();
  for (;;) {
    const { done, value } = await reader.read();
    if (done) {
      break;
    }
    parts.push(value);
    length += value.length;
    if (length > most) {
      await reader.cancel();
      throw new Error("the link is too long");
    }
  }
  const bytes = new Uint8Array(length);
  parts.reduce((at, part) => {
    bytes.set(part, at);
    return at + part.length;
  }, 0);
  return bytes;
}

function checked(value: unknown): Shared | undefined {
  if (typeof value !== "object" || value === null) {
    return undefined;
  }
  const { scenario, policy, set } = value as Record<string, unknown>;
  if (typeof scenario !== "string" || typeof policy !== "string") {
    return undefined;
  }
  const values = typeof set === "object" && set !== null ? Object.entries(set).slice(0, MOST_PARAMETERS) : [];
  const numbers = values.filter((entry): entry is [string, number] => typeof entry[1] === "number" && Number.isFinite(entry[1]));
  return { scenario, policy, set: Object.fromEntries(numbers) };
}
