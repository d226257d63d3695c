// How late things are, by this page's own clock: what was sent and is not heard yet, and how old the newest picture is.
//
// The cockpit answers every numbered message with the robot's newest time t and how long ago it came. If the message was
// sent at p0, the robot's time was t + ago at p0 or later: at the page's time p it is at most p + min(t + ago - p0). No
// two clocks are compared.

const QUIET_S = 0.1; // since when nothing has come to the cockpit: then old pictures are the robot's, not the link's
const DRIFT = 2e-4; // how fast the bound is given up again: more than two clocks drift apart

export class Delay {
  constructor() {
    this.reset();
  }

  reset() {
    this.away = []; // [seq, sent at] of what is not heard yet, oldest first [ms]
    this.ahead = Infinity; // the robot's time is at most the page's plus this [ms]
    this.at = 0;
    this.ago = 0; // how long ago the newest state had come to the cockpit, in its newest answer [s]
    this.trip = 0; // how long the newest answer took, there and back [ms]
    this.picture = null; // the robot's time of the newest picture [ms]
  }

  sent(seq, at) {
    this.away.push([seq, at]);
  }

  // The cockpit has heard everything up to seq, when the robot's time t [s] had come `ago` [s] before; 0: none yet.
  heard(seq, t, ago, at) {
    let from = null;
    while (this.away.length && this.away[0][0] <= seq) from = this.away.shift();
    if (from?.[0] !== seq) return;
    this.ago = ago;
    this.trip = at - from[1];
    if (!t) return;
    this.ahead = Math.min((t + ago) * 1000 - from[1], this.ahead + DRIFT * (at - this.at));
    this.at = at;
  }

  pictured(t) {
    if (t * 1000 < this.picture) this.ahead = Infinity; // another robot side, with another clock
    this.picture = t * 1000;
  }

  // Since when the oldest message that is not heard yet has been on its way [ms].
  unheard(at) {
    return this.away.length ? at - this.away[0][1] : 0;
  }

  // How old the newest picture is at most, up to the way of the fastest message [ms].
  age(at) {
    return this.picture === null || this.ahead === Infinity ? 0 : Math.max(0, at + this.ahead - this.picture);
  }

  // How late the link is.
  late(at) {
    return this.ago > QUIET_S ? this.unheard(at) : Math.max(this.unheard(at), this.age(at));
  }
}
