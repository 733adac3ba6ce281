// The contact graph: a square a node, and the mesh with the chosen node's triangles.

page.graph = (() => {
  const graph = page.data('graph-data');
  if (!graph) return null;
  const box = document.querySelector('#graph-view .matrix-box');
  const side = document.querySelector('#graph-view .graph-side');
  const n = graph.triangles, highest = Math.max(1e-12, ...graph.s_c);
  const ramp = (s) => graph.ramp[Math.round(Math.max(0, Math.min(1, s)) * (graph.ramp.length - 1))];
  const kept = (id) => 'cnb'.includes(graph.verdict[id]);
  const names = { c: 'kept by the score here', n: 'kept by the score without surroundings', b: 'kept by both scores', p: 'pruned', '-': 'not decided' };
  const why = (id) => {
    const [pattern, ...numbers] = graph.why[id].split(' ');
    return graph.patterns[pattern].split('#').map((text, i) => text + (numbers[i] ?? '')).join('') + '.';
  };
  let chosen = graph.rank_c.indexOf(1);

  box.replaceChildren();
  const matrix = page.add(box, 'canvas', {
    role: 'img', tabindex: 0, style: 'width: 100%; aspect-ratio: 1; cursor: pointer',
    'aria-label': 'All contact states: arrow keys choose one, what it says is read beside',
  });
  const drawMatrix = () => {
    const ratio = Math.min(window.devicePixelRatio || 1, 2), size = Math.round(matrix.clientWidth * ratio);
    if (!size) return;
    if (matrix.width !== size) matrix.width = matrix.height = size;
    const c = matrix.getContext('2d'), cell = size / n, gap = cell > 6 ? 1 : 0;
    c.clearRect(0, 0, size, size);
    for (let id = 0; id < n * n; ++id) {
      const x = id % n * cell, y = Math.floor(id / n) * cell;
      c.globalAlpha = graph.verdict[id] === 'p' ? 0.22 : 1;
      c.fillStyle = ramp(graph.s_c[id] / highest);
      c.fillRect(x, y, cell - gap, cell - gap);
      if (graph.verdict[id] === 'n' || graph.verdict[id] === 'b') {
        c.globalAlpha = 1;
        c.strokeStyle = page.color(graph.verdict[id] === 'n' ? '--bad' : '--good');
        c.lineWidth = Math.max(1, 0.16 * cell);
        c.strokeRect(x + 0.1 * cell, y + 0.1 * cell, 0.8 * cell - gap, 0.8 * cell - gap);
      }
    }
    c.globalAlpha = 1;
    c.strokeStyle = page.color('--ink');
    c.lineWidth = Math.max(1, 0.08 * cell);
    const row = Math.floor(chosen / n) * cell, column = chosen % n * cell;
    c.strokeRect(0, row, size, cell);
    c.strokeRect(column, 0, cell, size);
    c.lineWidth = Math.max(2, 0.2 * cell);
    c.strokeRect(column, row, cell, cell);
  };

  page.add(box, 'p', { class: 'hint' }, 'Rows: the thumb’s triangle, 0 at the top. Columns: the index finger’s, 0 at the left. A green rim: kept by both scores. Click a square, or go by arrow keys.');
  const controls = page.add(side, 'div', { class: 'controls' });
  const numberBox = page.add(controls, 'label', {}, 'node ');
  const number = page.add(numberBox, 'input', { type: 'number', min: 0, max: n * n - 1 });
  const firstPruned = () => {
    let best = -1;
    for (let id = 0; id < n * n; ++id) {
      if (graph.verdict[id] === 'p' && (best < 0 || graph.rank_c[id] < graph.rank_c[best])) best = id;
    }
    return best;
  };
  for (const [text, find] of [['best here', () => graph.rank_c.indexOf(1)], ['best alone', () => graph.rank_n.indexOf(1)], ['best pruned', firstPruned]]) {
    const button = page.add(controls, 'button', { type: 'button' }, text);
    button.addEventListener('click', () => { if (find() >= 0) choose(find()); });
  }
  const words = page.add(side, 'div', { 'aria-live': 'polite' });
  const mesh = page.add(side, 'canvas', {
    role: 'img', 'aria-label': 'The contact mesh with the chosen triangles; arrow keys turn it', style: 'width: 100%; aspect-ratio: 4 / 3; cursor: grab',
  });
  page.add(side, 'p', { class: 'hint' }, 'The thumb’s triangle is magenta, the index finger’s vermilion, with a broken rim where it is on the far side; the others have the colour of the best state that uses them. Drag the mesh to turn it.');

  // The mesh, painted from the back to the front.
  // As the object stands at the start.
  const turn = poseMatrix(space.steps[0].bodies[0], 0);
  const points = Array.from({ length: graph.V.length / 3 }, (_, i) => {
    const p = graph.V.slice(3 * i, 3 * i + 3);
    return upright([0, 1, 2].map((k) => turn[k] * p[0] + turn[4 + k] * p[1] + turn[8 + k] * p[2]));
  });
  const low = [0, 1, 2].map((k) => Math.min(...points.map((p) => p[k]))), high = [0, 1, 2].map((k) => Math.max(...points.map((p) => p[k])));
  const best = Array(n).fill(-1);
  graph.s_c.forEach((score, id) => {
    for (const t of [Math.floor(id / n), id % n]) best[t] = Math.max(best[t], score);
  });
  const start = space.cameras.story, back = upright(start.p_WCam.map((x, i) => x - start.p_WTarget[i]));
  const table = new Turntable(mesh, {
    azimuth: Math.atan2(back[1], back[0]), elevation: Math.asin(back[2] / Math.hypot(...back)), distance: 1,
    target: low.map((x, k) => 0.5 * (x + high[k])),
  }, () => drawMesh());
  const project = (axis, p) => axis.reduce((sum, x, k) => sum + x * (p[k] - table.target[k]), 0);
  // How far the mesh reaches to the side and up as it is seen first: that fills the canvas.
  const reach = [table.axes().right, table.axes().up].map((axis) => Math.max(...points.map((p) => Math.abs(project(axis, p)))));
  const drawMesh = () => {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.round(mesh.clientWidth * ratio), height = Math.round(mesh.clientHeight * ratio);
    if (!width) return;
    if (mesh.width !== width || mesh.height !== height) Object.assign(mesh, { width, height });
    const c = mesh.getContext('2d'), { right, up, back } = table.axes();
    const scale = 0.44 * Math.min(width / reach[0], height / reach[1]) / table.distance;
    const seen = points.map((p) => [width / 2 + scale * project(right, p), height / 2 - scale * project(up, p), project(back, p)]);
    const faces = Array.from({ length: n }, (_, t) => {
      const corners = [0, 1, 2].map((k) => seen[graph.F[3 * t + k]]);
      const [a, b, d] = corners;
      const front = (b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0]) < 0;
      return { t, corners, front, depth: a[2] + b[2] + d[2] };
    }).sort((a, b) => a.depth - b.depth);
    const outline = (corners) => {
      c.beginPath();
      corners.forEach(([x, y], i) => (i ? c.lineTo(x, y) : c.moveTo(x, y)));
      c.closePath();
    };
    const thumb = Math.floor(chosen / n), index = chosen % n;
    const finger = (t) => (t === thumb ? graph.thumb : t === index ? graph.index : null);
    c.clearRect(0, 0, width, height);
    c.lineJoin = 'round';
    for (const { t, corners, front } of faces) {
      if (!front) continue;
      outline(corners);
      c.fillStyle = finger(t) ?? (best[t] >= 0 ? ramp(best[t] / highest) : graph.plain);
      c.fill();
      c.strokeStyle = 'rgba(20, 24, 30, 0.55)';
      c.lineWidth = ratio;
      c.stroke();
    }
    for (const { t, corners, front } of faces) {
      const color = finger(t);
      if (!color || front) continue;
      outline(corners);
      c.globalAlpha = 0.35;
      c.fillStyle = color;
      c.fill();
      c.globalAlpha = 1;
      c.setLineDash([6 * ratio, 4 * ratio]);
      c.strokeStyle = color;
      c.lineWidth = 2.5 * ratio;
      c.stroke();
      c.setLineDash([]);
    }
    c.font = `${12 * ratio}px sans-serif`;
    c.textAlign = 'center';
    c.textBaseline = 'middle';
    for (const { t, corners, front } of faces) {
      const area = Math.abs((corners[1][0] - corners[0][0]) * (corners[2][1] - corners[0][1]) - (corners[1][1] - corners[0][1]) * (corners[2][0] - corners[0][0]));
      if (!(front && area > 900 * ratio * ratio) && !finger(t)) continue;
      const x = (corners[0][0] + corners[1][0] + corners[2][0]) / 3, y = (corners[0][1] + corners[1][1] + corners[2][1]) / 3;
      c.lineWidth = 3 * ratio;
      c.strokeStyle = 'rgba(255, 255, 255, 0.75)';
      c.strokeText(t, x, y);
      c.fillStyle = '#14181e';
      c.fillText(t, x, y);
    }
    if (thumb === index) {
      const same = faces.find((face) => face.t === thumb);
      outline(same.corners);
      c.strokeStyle = graph.index;
      c.lineWidth = 4 * ratio;
      c.stroke();
    }
  };

  const choose = (id) => {
    chosen = id;
    number.value = id;
    words.replaceChildren();
    const thumb = Math.floor(id / n), index = id % n;
    page.add(words, 'h3', { style: 'margin-top: .4rem' }, `Node ${id}: thumb on ${thumb}, index on ${index}`);
    page.add(words, 'p', { class: `verdict ${kept(id) ? 'kept' : graph.verdict[id] === 'p' ? 'pruned' : ''}` }, names[graph.verdict[id]]);
    const rows = page.add(page.add(words, 'table'), 'tbody');
    const row = (cells, name = 'td') => {
      const line = page.add(rows, 'tr');
      cells.forEach((text) => page.add(line, name, {}, text));
    };
    row(['', 'score', 'rank', 'threshold', `among the best ${graph.kept_each}`], 'th');
    for (const [name, score, rank, threshold] of [['here', graph.s_c[id], graph.rank_c[id], graph.threshold_c], ['alone', graph.s_n[id], graph.rank_n[id], graph.threshold_n]]) {
      row([name, score.toFixed(3), `${rank} of ${n * n}`, threshold.toFixed(3), rank <= graph.kept_each ? 'yes' : 'no']);
    }
    let neighbours = 0;
    for (let k = 0; k < n; ++k) neighbours += (k !== index && kept(thumb * n + k)) + (k !== thumb && kept(k * n + index));
    page.add(words, 'p', { style: 'margin-top: .6rem' }, why(id));
    if (kept(id)) page.add(words, 'p', { class: 'hint' }, `A finger stays on the way to ${neighbours} other states that were kept.`);
    drawMatrix();
    drawMesh();
  };
  number.addEventListener('change', () => {
    const id = Math.round(Number(number.value));
    if (id >= 0 && id < n * n) choose(id);
  });
  matrix.addEventListener('click', (event) => {
    const area = matrix.getBoundingClientRect();
    const column = Math.min(n - 1, Math.floor((event.clientX - area.left) / area.width * n));
    const row = Math.min(n - 1, Math.floor((event.clientY - area.top) / area.height * n));
    if (row >= 0 && column >= 0) choose(row * n + column);
  });
  matrix.addEventListener('keydown', (event) => {
    const moves = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0] };
    const move = moves[event.key];
    if (!move) return;
    event.preventDefault();
    const row = Math.max(0, Math.min(n - 1, Math.floor(chosen / n) + move[0]));
    const column = Math.max(0, Math.min(n - 1, chosen % n + move[1]));
    choose(row * n + column);
  });
  const redraw = () => { drawMatrix(); drawMesh(); };
  new ResizeObserver(redraw).observe(matrix);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
  choose(chosen);
  return { choose, why, count: n * n, words };
})();
