// Buttons that are held: each act of one lasts until the next message of the button is overdue.

const LASTS = 150; // ms after the last message of a button that is held

export class Hold {
  /** ms; 0 when nothing is held */
  until = 0;

  get isHeld() {
    return this.until > 0;
  }

  /** @param {number} now ms */
  isOver(now) {
    return this.isHeld && now > this.until;
  }

  /** Hold on: the button has sent a message. */
  renew() {
    this.until = performance.now() + LASTS;
  }

  end() {
    this.until = 0;
  }
}
