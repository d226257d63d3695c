// The WebSocket to the cockpit. Newest state in, commands and questions out; reconnects by itself.

const AGAIN_MS = 400;
const ANSWER_MS = 1500;

export class Link {
  constructor(handlers) {
    this.handlers = handlers; // welcome, state, settings, up, down
    this.operator = 0;
    this.waiting = new Map();
    this.nextId = 1;
    this.open();
  }

  open() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(`${scheme}://${location.host}/ws`);
    this.socket = socket;
    socket.onmessage = (event) => this.take(JSON.parse(event.data));
    socket.onclose = () => {
      if (this.socket !== socket) return;
      this.operator = 0;
      for (const [, done] of this.waiting) done({ done: false, reason: "The connection was lost." });
      this.waiting.clear();
      this.handlers.down();
      setTimeout(() => this.open(), AGAIN_MS);
    };
  }

  take(message) {
    if (message.type === "state") this.handlers.state(message.state);
    else if (message.type === "welcome") {
      this.operator = message.operator;
      this.handlers.welcome(message.robot, message.settings, message.scene);
      this.handlers.up();
    } else if (message.type === "settings") this.handlers.settings(message.settings, message.scene);
    else if (message.type === "answer") {
      this.waiting.get(message.id)?.(message);
      this.waiting.delete(message.id);
    }
  }

  get ready() {
    return this.socket.readyState === WebSocket.OPEN && this.operator !== 0;
  }

  send(message) {
    if (this.ready) this.socket.send(JSON.stringify(message));
  }

  // Ask for one of stop, reset, arm, disarm, restart; resolves to {done, reason}.
  ask(what) {
    return new Promise((resolve) => {
      if (!this.ready) return resolve({ done: false, reason: "Not connected." });
      const id = this.nextId++;
      const late = setTimeout(() => {
        this.waiting.delete(id);
        resolve({ done: false, reason: "No answer." });
      }, ANSWER_MS);
      this.waiting.set(id, (answer) => {
        clearTimeout(late);
        resolve(answer);
      });
      this.send({ type: "ask", id, what });
    });
  }
}
