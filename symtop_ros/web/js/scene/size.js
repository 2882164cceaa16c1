// The size of an element in px. To ask the element itself in every frame would have the browser lay
// out the whole page again.

export class Size {
  /** @param {HTMLElement} element */
  constructor(element) {
    this.width = element.clientWidth;
    this.height = element.clientHeight;
    new ResizeObserver(() => {
      this.width = element.clientWidth;
      this.height = element.clientHeight;
    }).observe(element);
  }
}
