// The scene and the hand in three dimensions, with WebGL 2 and nothing else.

const space = page.data('space-data');

// From the world to a frame that stands upright, z against gravity, and back: views turn in that.
const upright = (v) => [0, 1, 2].map((i) => v.reduce((sum, x, k) => sum + space.upright[3 * i + k] * x, 0));
const fromUpright = (v) => [0, 1, 2].map((i) => v.reduce((sum, x, k) => sum + space.upright[3 * k + i] * x, 0));

const floats = (text) => {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new Float32Array(bytes.buffer);
};

// Corners of triangles, with normals that are smooth but across edges of more than 40 degrees.
function unpackMesh(mesh) {
  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
  const v = new Uint16Array(bytes(mesh.v));
  const f = mesh.wide ? new Uint32Array(bytes(mesh.f)) : new Uint16Array(bytes(mesh.f));
  const at = (i) => [0, 1, 2].map((k) => mesh.low[k] + mesh.size[k] * v[3 * i + k] / 65535);
  const points = Array.from({ length: v.length / 3 }, (_, i) => at(i));
  const normals = [], around = points.map(() => []);
  for (let t = 0; t < f.length / 3; ++t) {
    const [a, b, c] = [0, 1, 2].map((k) => points[f[3 * t + k]]);
    const u = b.map((x, k) => x - a[k]), w = c.map((x, k) => x - a[k]);
    const n = [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]];
    normals.push({ n, length: Math.hypot(...n) || 1e-30 });
    for (let k = 0; k < 3; ++k) around[f[3 * t + k]].push(t);
  }
  const out = new Float32Array(f.length * 6);
  for (let i = 0; i < f.length; ++i) {
    const own = normals[Math.floor(i / 3)], sum = [0, 0, 0];
    for (const t of around[f[i]]) {
      const { n, length } = normals[t];
      const cosine = (n[0] * own.n[0] + n[1] * own.n[1] + n[2] * own.n[2]) / (length * own.length);
      if (cosine > 0.766) for (let k = 0; k < 3; ++k) sum[k] += n[k];
    }
    const length = Math.hypot(...sum) || 1;
    out.set(points[f[i]], 6 * i);
    out.set(sum.map((x) => x / length), 6 * i + 3);
  }
  return out;
}

function ballMesh() {
  const out = [], rings = 12, sides = 24;
  const at = (i, j) => {
    const a = Math.PI * i / rings, b = 2 * Math.PI * j / sides;
    return [Math.sin(a) * Math.cos(b), Math.sin(a) * Math.sin(b), Math.cos(a)];
  };
  for (let i = 0; i < rings; ++i) {
    for (let j = 0; j < sides; ++j) {
      const [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
      for (const p of [a, b, c, a, c, d]) out.push(...p, ...p);
    }
  }
  return new Float32Array(out);
}

// Along z from 0 to 1: a shaft and a head, as wide as 1 to all sides.
function arrowMesh() {
  const out = [], sides = 16;
  const ring = (j, r, z) => [r * Math.cos(2 * Math.PI * j / sides), r * Math.sin(2 * Math.PI * j / sides), z];
  const band = (r0, z0, r1, z1, up) => {
    for (let j = 0; j < sides; ++j) {
      const quad = [ring(j, r0, z0), ring(j + 1, r0, z0), ring(j + 1, r1, z1), ring(j, r1, z1)];
      for (const k of [0, 1, 2, 0, 2, 3]) {
        const n = [quad[k][0], quad[k][1], 0], length = Math.hypot(n[0], n[1]) || 1;
        out.push(...quad[k], n[0] / length, n[1] / length, up);
      }
    }
  };
  band(0.36, 0, 0.36, 0.72, 0);
  band(1, 0.72, 0.001, 1, 0.6);
  return new Float32Array(out);
}

// Column-major: an arrow that ends at p, along the force f.
function arrowMatrix(p, f) {
  const newtons = Math.hypot(...f), { per_newton, shortest, longest, radius } = space.force;
  const length = Math.max(shortest, Math.min(longest, per_newton * newtons));
  const z = f.map((x) => x / newtons), side = Math.abs(z[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const x = cross(side, z), scale = Math.hypot(...x), u = x.map((c) => c / scale), v = cross(z, u);
  return new Float32Array([
    ...u.map((c) => radius * c), 0, ...v.map((c) => radius * c), 0, ...z.map((c) => length * c), 0,
    ...p.map((c, i) => c - length * z[i]), 1]);
}

// Column-major: the pose x, y, z, w, i, j, k at pose[at], scaled.
function poseMatrix(pose, at, scale = 1) {
  const [x, y, z, w, i, j, k] = pose.slice(at, at + 7);
  return new Float32Array([
    scale * (1 - 2 * (j * j + k * k)), scale * 2 * (i * j + w * k), scale * 2 * (i * k - w * j), 0,
    scale * 2 * (i * j - w * k), scale * (1 - 2 * (i * i + k * k)), scale * 2 * (j * k + w * i), 0,
    scale * 2 * (i * k + w * j), scale * 2 * (j * k - w * i), scale * (1 - 2 * (i * i + j * j)), 0,
    x, y, z, 1]);
}

const linear = (hex) => [1, 3, 5].map((i) => Math.pow(parseInt(hex.slice(i, i + 2), 16) / 255, 2.2));

const vertexShader = `#version 300 es
in vec3 p; in vec3 n;
uniform mat4 model, view;
out vec3 normal, place;
void main() {
  vec4 at = model * vec4(p, 1.0);
  place = at.xyz;
  normal = mat3(model) * n;
  gl_Position = view * at;
}`;
const fragmentShader = `#version 300 es
precision highp float;
in vec3 normal, place;
uniform vec3 color, eye, light, zenith;
uniform float lit;
out vec4 result;
void main() {
  vec3 n = normalize(normal), to_eye = normalize(eye - place);
  if (dot(n, to_eye) < 0.0) n = -n;
  float key = max(dot(n, light), 0.0), sky = 0.5 + 0.5 * dot(n, zenith), side = max(dot(n, to_eye), 0.0);
  vec3 half_way = normalize(light + to_eye);
  float shine = pow(max(dot(n, half_way), 0.0), 40.0) * 0.12;
  vec3 c = color * (0.16 + 0.26 * sky + 0.18 * side + 0.48 * key) + shine;
  result = vec4(pow(mix(color, c, lit), vec3(1.0 / 2.2)), 1.0);
}`;

// A canvas that shows poses. `start` is a camera as the pictures have it.
class SpaceView {
  constructor(canvas, start) {
    this.canvas = canvas;
    const gl = canvas.getContext('webgl2', { antialias: true, preserveDrawingBuffer: true });
    if (!gl) return;
    this.gl = gl;
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertexShader], [gl.FRAGMENT_SHADER, fragmentShader]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    gl.useProgram(program);
    this.uniform = (name) => gl.getUniformLocation(program, name);
    this.program = program;
    this.meshes = space.meshes.map((mesh) => this.upload(unpackMesh(mesh)));
    this.ball = this.upload(ballMesh());
    this.arrow = this.upload(arrowMesh());
    this.ground = Math.min(...space.bodies.filter((body) => body.pose).map((body) => {
      const mesh = space.meshes[body.mesh], m = poseMatrix(body.pose, 0);
      let lowest = Infinity;
      for (let i = 0; i < 8; ++i) {
        const p = [0, 1, 2].map((k) => mesh.low[k] + (i >> k & 1) * mesh.size[k]);
        const corner = [0, 1, 2].map((k) => m[k] * p[0] + m[4 + k] * p[1] + m[8 + k] * p[2] + m[12 + k]);
        lowest = Math.min(lowest, upright(corner)[2]);
      }
      return lowest;
    }), 0);
    this.grid = this.upload(this.gridLines());
    const back = upright(start.p_WCam.map((x, i) => x - start.p_WTarget[i])), distance = Math.hypot(...back);
    this.fov = start.fov_deg * Math.PI / 180;
    this.camera = new Turntable(canvas, {
      azimuth: Math.atan2(back[1], back[0]), elevation: Math.asin(back[2] / distance), distance,
      target: upright(start.p_WTarget),
    }, () => this.draw());
    new ResizeObserver(() => this.draw()).observe(canvas);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.draw());
  }
  get works() { return Boolean(this.gl); }

  upload(data) {
    const gl = this.gl, array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    for (const [name, offset] of [['p', 0], ['n', 12]]) {
      const at = gl.getAttribLocation(this.program, name);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, 3, gl.FLOAT, false, 24, offset);
    }
    return { array, count: data.length / 6 };
  }
  gridLines() {
    const out = [], n = 10, step = 0.1, z = this.ground - 1e-3;
    for (let i = -n; i <= n; ++i) {
      for (const line of [[[i, -n], [i, n]], [[-n, i], [n, i]]]) {
        for (const [x, y] of line) out.push(...fromUpright([x * step, y * step, z]), 0, 0, 1);
      }
    }
    return new Float32Array(out);
  }

  // pose: {bodies: poses in a row, hand?: links' poses, on?: fingers that touch, fingers?: [number, contact, normal, force]}
  show(pose) {
    this.pose = pose;
    this.draw();
  }
  draw() {
    if (!this.gl || !this.pose || !this.canvas.clientWidth) return;
    const gl = this.gl, ratio = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.round(this.canvas.clientWidth * ratio), height = Math.round(this.canvas.clientHeight * ratio);
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    gl.viewport(0, 0, width, height);
    const ground = linear(page.color('--ground') || '#e7e4dc').map((x) => Math.pow(x, 1 / 2.2));
    gl.clearColor(...ground, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.useProgram(this.program);
    const axes = this.camera.axes();
    const [right, up, back, target, zenith] = [axes.right, axes.up, axes.back, this.camera.target, [0, 0, 1]].map(fromUpright);
    const eye = target.map((x, i) => x + this.camera.distance * back[i]);
    gl.uniformMatrix4fv(this.uniform('view'), false, this.viewMatrix(right, up, back, eye, width / height));
    gl.uniform3fv(this.uniform('eye'), eye);
    const light = [0, 1, 2].map((i) => 0.9 * back[i] - 0.45 * right[i] + 0.9 * up[i] + 0.6 * zenith[i]);
    gl.uniform3fv(this.uniform('zenith'), zenith);
    const length = Math.hypot(...light);
    gl.uniform3fv(this.uniform('light'), light.map((x) => x / length));
    this.drawMesh(this.grid, poseMatrix([0, 0, 0, 1, 0, 0, 0], 0), page.color('--grid'), 0, gl.LINES);
    let movable = 0;
    for (const body of space.bodies) {
      const matrix = body.pose ? poseMatrix(body.pose, 0) : poseMatrix(this.pose.bodies, 7 * movable++);
      this.drawMesh(this.meshes[body.mesh], matrix, body.color);
    }
    if (this.pose.hand) {
      for (const part of space.hand) {
        const touches = part.tip >= 0 && (this.pose.on || []).includes(part.tip);
        this.drawMesh(this.meshes[part.mesh], poseMatrix(this.pose.hand, 7 * part.link),
                      touches ? space.fingers[part.tip].color : part.color);
      }
    }
    for (const [number, ...at] of this.pose.fingers || []) {
      const { radius, color } = space.fingers[number];
      const p = at.slice(0, 3), force = at.slice(6, 9);
      const center = p.map((x, i) => x + radius * at[3 + i]);
      if (!this.pose.hand) this.drawMesh(this.ball, poseMatrix([...center, 1, 0, 0, 0], 0, radius), color);
      if (Math.hypot(...force) > 1e-3) this.drawArrow(arrowMatrix(p, force), color);
    }
  }
  // What bodies hide of it shines through.
  drawArrow(matrix, color) {
    const gl = this.gl;
    gl.disable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendColor(0, 0, 0, 0.4);
    gl.blendFunc(gl.CONSTANT_ALPHA, gl.ONE_MINUS_CONSTANT_ALPHA);
    this.drawMesh(this.arrow, matrix, '#ffffff', 0);
    gl.disable(gl.BLEND);
    gl.enable(gl.DEPTH_TEST);
    this.drawMesh(this.arrow, matrix, color);
  }
  drawMesh(mesh, matrix, color, lit = 1, kind = this.gl.TRIANGLES) {
    const gl = this.gl;
    gl.bindVertexArray(mesh.array);
    gl.uniformMatrix4fv(this.uniform('model'), false, matrix);
    gl.uniform3fv(this.uniform('color'), linear(color));
    gl.uniform1f(this.uniform('lit'), lit);
    gl.drawArrays(kind, 0, mesh.count);
  }
  viewMatrix(right, up, back, eye, aspect) {
    const near = 0.02 * this.camera.distance, far = 20 * this.camera.distance + 4;
    const f = 1 / Math.tan(0.5 * this.fov), c = (far + near) / (near - far), d = 2 * far * near / (near - far);
    const dot = (a) => -(a[0] * eye[0] + a[1] * eye[1] + a[2] * eye[2]);
    const r = [...right, dot(right)], u = [...up, dot(up)], b = [...back, dot(back)];
    const out = new Float32Array(16);
    for (let i = 0; i < 4; ++i) {
      out[4 * i] = f / aspect * r[i];
      out[4 * i + 1] = f * u[i];
      out[4 * i + 2] = c * b[i] + (i === 3 ? d : 0);
      out[4 * i + 3] = -b[i];
    }
    return out;
  }
}

// The pose of a step, as SpaceView takes it.
space.stepPose = (number) => {
  const step = space.steps[number];
  return {
    bodies: step.bodies.flat(), hand: step.hand ? floats(step.hand) : null, on: step.on || [],
    fingers: step.fingers || [],
  };
};

// The film: the hand's motion, or what was simulated.
page.film = (() => {
  const box = document.getElementById('film-view');
  const section = document.getElementById('space');
  const film = space.film;
  if (!film) {
    section.remove();
    document.querySelector('nav a[href="#space"]')?.parentElement.remove();
    return null;
  }
  const frame = page.add(box, 'div', { class: 'view' });
  const canvas = page.add(frame, 'canvas', {
    role: 'img', 'aria-label': 'The scene in three dimensions; arrow keys turn it, plus and minus come nearer and go away',
  });
  const view = new SpaceView(canvas, space.cameras.film);
  if (!view.works) {
    frame.remove();
    page.add(box, 'p', { class: 'hint' }, 'This browser shows no WebGL; the pictures below show the same.');
    return null;
  }
  const count = film.t.length, bodies = floats(film.bodies), hand = film.hand ? floats(film.hand) : null;
  const perFrame = bodies.length / count, links = 7 * space.links;
  const controls = page.add(box, 'div', { class: 'controls' });
  const play = page.add(controls, 'button', { type: 'button' }, 'Play');
  const slider = page.add(controls, 'input', { type: 'range', min: 0, max: count - 1, value: 0, 'aria-label': 'time of the motion' });
  const speed = page.add(controls, 'select', { 'aria-label': 'speed' });
  for (const [value, text] of [['1', 'as it is'], ['0.5', 'half as fast'], ['0.2', 'a fifth as fast']]) page.add(speed, 'option', { value }, text);
  const label = page.add(controls, 'output', { 'aria-live': 'off' });
  page.add(box, 'p', { class: 'hint' }, 'Arrows are the fingers’ forces on the object. Drag to turn, with shift to move; arrow keys turn, + and - come nearer and go away, Home goes back.');
  const bits = (mask) => space.fingers.map((_, i) => i).filter((i) => mask >> i & 1);
  const show = (i) => {
    const on = film.on ? bits(film.on[i]) : [];
    view.show({
      bodies: bodies.subarray(i * perFrame, (i + 1) * perFrame),
      hand: hand && hand.subarray(i * links, (i + 1) * links), on, fingers: film.fingers[i],
    });
    slider.value = i;
    const forces = new Map(film.fingers[i].map(([f, ...at]) => [f, Math.hypot(...at.slice(6, 9))]));
    const touching = (film.on ? on : [...forces.keys()]).map((f) => space.fingers[f].name + (forces.get(f) > 1e-3 ? ` ${forces.get(f).toFixed(2)} N` : '')).join(', ');
    label.textContent = `t = ${film.t[i].toFixed(2)} s` + (film.phase ? ` · ${film.phase[i]}` : '') + (touching ? ` · ${touching}` : '');
  };
  let timer = null;
  const stop = () => {
    clearTimeout(timer);
    timer = null;
    play.textContent = 'Play';
  };
  // Whoever asked for less motion gets half a second a picture, as a row of stills.
  const stride = page.reduced ? 15 : 1;
  const step = () => {
    const i = Number(slider.value), next = Math.min(count - 1, i + stride);
    if (i >= count - 1) return stop();
    show(next);
    const wait = page.reduced ? 0.8 : (film.t[next] - film.t[i]) / Number(speed.value);
    timer = setTimeout(step, 1000 * wait);
  };
  play.addEventListener('click', () => {
    if (timer) return stop();
    if (Number(slider.value) >= count - 1) show(0);
    play.textContent = 'Pause';
    timer = setTimeout(step, 0);
  });
  slider.addEventListener('input', () => { stop(); show(Number(slider.value)); });
  // Where fingers have come to the object, if they do.
  const first = film.on ? film.on.findIndex((mask) => mask > 0) : film.fingers.findIndex((tips) => tips.length > 0);
  show(Math.max(0, first));
  return { view, show, count };
})();
