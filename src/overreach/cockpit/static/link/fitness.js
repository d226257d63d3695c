// Whether the link is good enough to drive by. It changes its mind seldom: each time that it was wrong to let somebody
// drive, it waits twice as long before it does so again.

export const LATE_MS = 500; // later than this, nobody drives from here
export const WELL_MS = 300; // at most this late, for a while, and it is good again
const FIRST_MS = 1000;
const LONGEST_MS = 60000;
const FORGET_MS = 60000; // good for this long, and the waiting starts anew at FIRST_MS
const HUNG_MS = 250; // a page that was itself busy for longer than this ...
const CATCH_UP_MS = 300; // ... takes this long to look at what has come meanwhile ...
const EXCUSED_MS = 2000; // ... and is not excused for longer than this, until it has been well for as long

export class Fitness {
  constructor() {
    this.reset();
  }

  reset() {
    this.good = true;
    this.wait = FIRST_MS;
    this.since = this.bad = this.looked = performance.now();
    this.hung = this.excused = -Infinity;
  }

  // Take in how late things are now [ms]; call at least every HUNG_MS / 2. Returns whether one may drive.
  look(late, at) {
    if (at - this.looked > HUNG_MS) {
      if (at - this.hung > EXCUSED_MS) this.excused = at;
      this.hung = at;
    }
    this.looked = at;
    if (at - this.hung < CATCH_UP_MS && at - this.excused < EXCUSED_MS) {
      this.bad = at; // not known to be well
      return this.good;
    }
    if (this.good) {
      if (at - this.since > FORGET_MS) this.wait = FIRST_MS;
      if (late > LATE_MS) {
        this.good = false;
        this.bad = at;
      }
    } else {
      if (late > WELL_MS) this.bad = at;
      if (at - this.bad > this.wait) {
        this.good = true;
        this.since = at;
        this.wait = Math.min(LONGEST_MS, 2 * this.wait);
      }
    }
    return this.good;
  }
}
