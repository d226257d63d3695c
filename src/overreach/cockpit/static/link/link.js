// The WebSocket to the cockpit. Newest picture in, commands and questions out; reconnects by itself.
// Commands and beats are numbered, and the cockpit says up to which number it has heard.

import { Delay } from "./delay.js";

const AGAIN_MS = 400;
const ANSWER_MS = 3000;
const BEAT_MS = 300; // where nothing else is sent: to know how late the link is
const DEAF_MS = 10000; // nothing at all for this long: open it anew
const JUMP_S = 1; // a time that goes back by more than this is of another robot side
const OPENING_MS = 5000; // the same where it does not even open

export class Link {
  constructor(handlers) {
    this.handlers = handlers; // welcome, state, settings, heard, told, up, down
    this.operator = 0;
    this.waiting = new Map();
    this.nextId = 1;
    this.seq = 0;
    this.t = null; // the robot's newest time that has come here [s]
    this.shown = 0; // number of the newest picture
    this.told = 0; // number of the newest picture that the cockpit has been told of
    this.delay = new Delay();
    this.open();
    setInterval(() => this.beat(), BEAT_MS / 3);
  }

  open() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(`${scheme}://${location.host}/ws`);
    this.socket = socket;
    this.heardAt = performance.now();
    socket.onmessage = (event) => {
      this.heardAt = performance.now();
      this.take(JSON.parse(event.data));
    };
    socket.onclose = () => this.lost(socket);
  }

  lost(socket) {
    if (this.socket !== socket) return;
    this.operator = 0;
    for (const [, done] of this.waiting) done({ done: false, reason: "The connection was lost." });
    this.waiting.clear();
    this.handlers.down();
    setTimeout(() => this.socket === socket && this.open(), AGAIN_MS);
  }

  take(message) {
    const at = performance.now();
    if (message.type === "state") {
      this.shown = message.n;
      if (message.state.t > this.t || message.state.t < this.t - JUMP_S) this.t = message.state.t;
      this.delay.pictured(message.state.t);
      this.handlers.state(message.state);
      if (this.shown > this.told && !(this.soon?.() && this.shown - this.told < 3)) this.send({ type: "shown", n: this.acknowledge() });
    } else if (message.type === "heard") {
      if (message.t > this.t) this.t = message.t;
      this.delay.heard(message.seq, message.t, message.ago, at);
      this.handlers.heard();
    } else if (message.type === "welcome") {
      const again = this.operator === message.operator;
      this.operator = message.operator;
      this.t = null;
      this.delay.reset();
      if (!again) this.told = this.shown = 0;
      this.handlers.welcome(message.robot, message.settings, message.scene);
      this.handlers.up();
      this.beat();
    } else if (message.type === "settings") this.handlers.settings(message.settings, message.scene);
    else if (message.type === "answer") {
      if (this.waiting.has(message.id)) this.waiting.get(message.id)(message);
      else if (message.id < 0) this.handlers.told(message.reason); // nobody asked
      this.waiting.delete(message.id);
    }
  }

  get ready() {
    return this.socket.readyState === WebSocket.OPEN && this.operator !== 0;
  }

  // How many numbered messages are on their way.
  get away() {
    return this.delay.away.length;
  }

  acknowledge() {
    this.told = this.shown;
    return this.shown;
  }

  send(message) {
    if (this.ready) this.socket.send(JSON.stringify(message));
  }

  // Send a message that the cockpit answers by its number.
  sendNumbered(message) {
    if (!this.ready) return;
    this.seq += 1;
    this.sentAt = performance.now();
    this.delay.sent(this.seq, this.sentAt);
    this.send({ ...message, seq: this.seq, shown: this.acknowledge() });
  }

  beat() {
    const now = performance.now();
    const patience = this.socket.readyState === WebSocket.CONNECTING ? OPENING_MS : DEAF_MS;
    if (this.socket.readyState !== WebSocket.CLOSED && now - this.heardAt > patience) {
      const deaf = this.socket; // a close may take its time to be told: what comes of it is not waited for
      deaf.onclose = deaf.onmessage = null;
      deaf.close();
      return this.lost(deaf);
    }
    if (this.ready && this.away === 0 && !this.soon?.() && !(now - this.sentAt < BEAT_MS)) this.sendNumbered({ type: "beat", seen: this.t });
  }

  // Ask for one of stop, reset, arm, disarm, restart, or for a frame; resolves to {done, reason, late}.
  ask(what) {
    return new Promise((resolve) => {
      if (!this.ready) return resolve({ done: false, reason: "Not connected." });
      const id = this.nextId++;
      const late = setTimeout(() => {
        this.waiting.delete(id);
        resolve({ done: false, late: true, reason: "No answer yet: it may still be done." });
      }, ANSWER_MS);
      this.waiting.set(id, (answer) => {
        clearTimeout(late);
        resolve(answer);
      });
      this.send({ type: "ask", id, what });
    });
  }
}
