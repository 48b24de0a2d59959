import type { PageMessage, ServerMessage } from "./protocol.ts";

/** The time (ms) before another attempt to connect. */
const PAUSE = 1000;

/** What a page sends its messages to. */
export interface Peer {
  send(message: PageMessage): void;
}

/** Makes a connection. It passes messages on, and says whether it is open. */
export type Connect = (receive: (message: ServerMessage) => void, change: (isOpen: boolean) => void) => Peer;

/** The connection to the program. It is made again after it was lost. */
export class Connection implements Peer {
  readonly #receive: (message: ServerMessage) => void;
  readonly #change: (isOpen: boolean) => void;
  #socket: WebSocket | undefined;

  constructor(receive: (message: ServerMessage) => void, change: (isOpen: boolean) => void) {
    [this.#receive, this.#change] = [receive, change];
    this.#open();
  }

  send(message: PageMessage): void {
    if (this.#socket?.readyState === WebSocket.OPEN) {
      this.#socket.send(JSON.stringify(message));
    }
  }

  #open(): void {
    // The query has the token.
    const socket = new WebSocket(`ws${location.protocol.slice(4)}//${location.host}/live${location.search}`, "vibrissa.live.v1");
    socket.addEventListener("message", (event) => this.#receive(JSON.parse(String(event.data)) as ServerMessage));
    socket.addEventListener("open", () => this.#change(true));
    socket.addEventListener("close", () => {
      this.#change(false);
      setTimeout(() => this.#open(), PAUSE);
    });
    this.#socket = socket;
  }
}
