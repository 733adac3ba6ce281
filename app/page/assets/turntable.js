'use strict';
// What the page's scripts share, and views that are turned by mouse, touch or keys.

const page = { errors: [] };
window.addEventListener('error', (event) => {
  page.errors.push(String(event.message));
  document.documentElement.dataset.errors = page.errors.join(' | ');
});
document.documentElement.classList.add('scripts');
page.reduced = matchMedia('(prefers-reduced-motion: reduce)').matches;
page.data = (id) => {
  const element = document.getElementById(id);
  return element ? JSON.parse(element.textContent) : null;
};
page.add = (parent, name, settings = {}, text = '') => {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(settings)) element.setAttribute(key, value);
  if (text) element.textContent = text;
  parent.append(element);
  return element;
};
page.color = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// A camera on a ball around a target: azimuth and elevation [rad], distance.
class Turntable {
  constructor(canvas, start, redraw) {
    this.canvas = canvas;
    this.start = start;
    this.redraw = redraw;
    this.reset();
    canvas.tabIndex = 0;
    let last = null;
    canvas.addEventListener('pointerdown', (event) => {
      last = [event.clientX, event.clientY];
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener('pointermove', (event) => {
      if (!last) return;
      const dx = event.clientX - last[0], dy = event.clientY - last[1];
      last = [event.clientX, event.clientY];
      event.shiftKey ? this.shift(dx, dy) : this.turn(-dx * 0.008, dy * 0.008);
    });
    for (const name of ['pointerup', 'pointercancel']) canvas.addEventListener(name, () => { last = null; });
    // The wheel scrolls the page, unless the view has been chosen.
    canvas.addEventListener('wheel', (event) => {
      if (document.activeElement !== canvas) return;
      event.preventDefault();
      this.zoom(Math.exp(event.deltaY * 0.001));
    }, { passive: false });
    canvas.addEventListener('keydown', (event) => {
      const actions = {
        ArrowLeft: () => this.turn(-0.12, 0), ArrowRight: () => this.turn(0.12, 0),
        ArrowUp: () => this.turn(0, 0.08), ArrowDown: () => this.turn(0, -0.08),
        '+': () => this.zoom(0.87), '=': () => this.zoom(0.87), '-': () => this.zoom(1.15),
        Home: () => { this.reset(); this.redraw(); },
      };
      if (!actions[event.key] || event.ctrlKey || event.metaKey) return;
      event.preventDefault();
      actions[event.key]();
    });
  }
  reset() {
    Object.assign(this, this.start, { target: this.start.target.slice() });
  }
  turn(azimuth, elevation) {
    this.azimuth += azimuth;
    this.elevation = Math.max(-1.5, Math.min(1.5, this.elevation + elevation));
    this.redraw();
  }
  zoom(factor) {
    this.distance = Math.max(this.start.distance / 20, Math.min(this.start.distance * 6, this.distance * factor));
    this.redraw();
  }
  shift(dx, dy) {
    const { right, up } = this.axes();
    const scale = this.distance / this.canvas.clientHeight;
    for (let i = 0; i < 3; ++i) this.target[i] += scale * (dy * up[i] - dx * right[i]);
    this.redraw();
  }
  // Right, up and towards the viewer, in the world.
  axes() {
    const ca = Math.cos(this.azimuth), sa = Math.sin(this.azimuth);
    const ce = Math.cos(this.elevation), se = Math.sin(this.elevation);
    return { right: [-sa, ca, 0], up: [-ca * se, -sa * se, ce], back: [ca * ce, sa * ce, se] };
  }
}
