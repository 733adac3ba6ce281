// All steps by a slider: the picture of a step that has one, else where everything is then.

page.steps = (() => {
  const box = document.getElementById('step-view');
  const rows = Array.from(document.querySelectorAll('#step-list tr[id]'));
  const pictures = new Map(Array.from(document.querySelectorAll('img[data-picture]'), (image) => [Number(image.dataset.picture), image]));
  const controls = page.add(box, 'div', { class: 'controls' });
  const before = page.add(controls, 'button', { type: 'button', 'aria-label': 'the step before' }, '◀');
  const slider = page.add(controls, 'input', { type: 'range', min: 1, max: rows.length, value: 1, 'aria-label': 'step' });
  const after = page.add(controls, 'button', { type: 'button', 'aria-label': 'the next step' }, '▶');
  const turn = page.add(controls, 'button', { type: 'button', 'aria-pressed': 'false' }, 'In space');
  const stage = page.add(box, 'div', { class: 'stage' });
  const left = page.add(stage, 'div');
  const words = page.add(stage, 'div', { class: 'words', 'aria-live': 'polite' });
  const image = page.add(left, 'img', { alt: '' });
  const frame = page.add(left, 'div', { class: 'view' });
  const canvas = page.add(frame, 'canvas', { role: 'img', 'aria-label': 'The step in three dimensions; arrow keys turn it' });
  const none = page.add(left, 'p', { class: 'hint' }, 'No picture of this step is on the page.');
  const view = new SpaceView(canvas, space.cameras.story);
  if (!view.works) turn.remove();
  let turned = false;
  const show = (number) => {
    const cells = rows[number - 1].children;
    slider.value = number;
    slider.setAttribute('aria-valuetext', cells[1].textContent);
    const picture = pictures.get(number);
    const in_space = view.works && Boolean(space.steps[number - 1]) && (turned || !picture);
    image.hidden = in_space || !picture;
    frame.hidden = !in_space;
    none.hidden = in_space || Boolean(picture);
    if (picture && !in_space) Object.assign(image, { src: picture.src, alt: picture.alt });
    words.replaceChildren();
    const heading = page.add(words, 'h4');
    page.add(heading, 'code', {}, cells[1].textContent);
    page.add(heading, 'span', { class: 'time' }, `${number} of ${rows.length}, t = ${cells[3].textContent}`);
    words.append(...Array.from(cells[4].cloneNode(true).childNodes));
    const from = cells[2].textContent;
    if (from) page.add(words, 'p', { class: 'hint' }, `made from ${from}`);
    if (in_space) view.show(space.stepPose(number - 1));
  };
  const go = (by) => show(Math.max(1, Math.min(rows.length, Number(slider.value) + by)));
  before.addEventListener('click', () => go(-1));
  after.addEventListener('click', () => go(1));
  slider.addEventListener('input', () => show(Number(slider.value)));
  turn.addEventListener('click', () => {
    turned = !turned;
    turn.setAttribute('aria-pressed', String(turned));
    show(Number(slider.value));
  });
  document.addEventListener('click', (event) => {
    const link = event.target.closest('a[data-step]');
    if (!link) return;
    event.preventDefault();
    show(Number(link.dataset.step));
    document.getElementById('steps').scrollIntoView();
    slider.focus({ preventScroll: true });
  });
  show(Math.max(1, Math.min(...pictures.keys(), rows.length)));
  return { show, count: rows.length, view, words };
})();

// The page tries itself, for a test: report.html#check leaves in <html data-check> what came of it.
if (location.hash === '#check') {
  const sees = (view) => {
    if (!view || !view.works) return false;
    view.draw();
    const gl = view.gl, pixels = new Uint8Array(4 * view.canvas.width * view.canvas.height);
    gl.readPixels(0, 0, view.canvas.width, view.canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    const colors = new Set();
    for (let i = 0; i < pixels.length; i += 4) colors.add(pixels[i] << 16 | pixels[i + 1] << 8 | pixels[i + 2]);
    return colors.size > 50;
  };
  const stride = Math.max(1, Math.floor(page.steps.count / 10));  // software draws slowly
  for (let i = 1; i <= page.steps.count; i += stride) page.steps.show(i);
  const reasons = new Set();
  if (page.graph) {
    for (let id = 0; id < page.graph.count; ++id) reasons.add(page.graph.why(id));
    page.graph.choose(page.graph.count - 1);
  }
  document.documentElement.dataset.check = JSON.stringify({
    steps: page.steps.count, words: page.steps.words.textContent.length > 0,
    film: page.film ? page.film.count : 0, filmSeen: sees(page.film?.view),
    reasons: reasons.size, chosen: page.graph ? page.graph.words.textContent.length : 0,
    pictures: Array.from(document.images).filter((image) => image.src && !image.hidden && image.complete && image.naturalWidth > 0).length,
    errors: page.errors,
  });
}
