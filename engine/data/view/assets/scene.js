// The same in 3-D: boxes of the town, walk, bodies and flights, drawn by WebGL where the browser has it. World: x ahead, y right, z up.
"use strict";

const MOST_SOLID = 20000;
const SHADER = `
attribute vec3 place;
attribute vec3 colour;
uniform mat4 view;
varying vec3 seen;
void main() { seen = colour; gl_Position = view * vec4(place, 1.0); }`;
const PAINTER = "precision mediump float; varying vec3 seen; void main() { gl_FragColor = vec4(seen, 1.0); }";

class Scene {
  constructor(canvas) {
    this.canvas = canvas;
    this.gl = canvas.getContext("webgl");
    this.eye = { x: 0, y: 0, z: 0, distance: 60, yaw: -2.2, pitch: 1.05 };
    this.shown = null;
    this.frame = 0;
    if (!this.gl) return;
    this.prepare();
    let from = null;
    canvas.addEventListener("webglcontextlost", event => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => { this.prepare(); if (this.shown) this.rebuild(); this.draw(this.frame); });
    canvas.addEventListener("pointerdown", event => { from = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); });
    canvas.addEventListener("pointerup", () => { from = null; });
    canvas.addEventListener("pointermove", event => {
      if (!from) return;
      const [right, down] = [event.clientX - from[0], event.clientY - from[1]];
      from = [event.clientX, event.clientY];
      this.turn(event.shiftKey ? 0 : right / 200, event.shiftKey ? 0 : down / 200);
      if (event.shiftKey) this.shift(right, down);
    });
    canvas.addEventListener("wheel", event => { event.preventDefault(); this.zoom(Math.exp(event.deltaY / 400)); }, { passive: false });
    canvas.addEventListener("keydown", event => {
      if (event.key === "+" || event.key === "-") this.zoom(event.key === "+" ? 1 / 1.3 : 1.3);
    });
    new ResizeObserver(() => this.draw(this.frame)).observe(canvas);
  }

  get isThere() {
    return this.gl !== null;
  }

  prepare() {
    const gl = this.gl;
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, SHADER], [gl.FRAGMENT_SHADER, PAINTER]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    gl.useProgram(program);
    gl.enable(gl.DEPTH_TEST);
    this.program = program;
    this.still = { buffer: gl.createBuffer(), count: 0 };
    this.moving = { buffer: gl.createBuffer(), count: 0 };
  }

  turn(yaw, pitch) {
    this.eye.yaw += yaw;
    this.eye.pitch = Math.max(0.05, Math.min(1.5, this.eye.pitch + pitch));
    this.draw(this.frame);
  }

  // Moves over the ground by pixels of the canvas.
  shift(right, down) {
    const { yaw, distance } = this.eye;
    const step = distance / this.canvas.clientHeight;
    this.eye.x -= step * (right * Math.sin(yaw) + down * Math.cos(yaw));
    this.eye.y += step * (right * Math.cos(yaw) - down * Math.sin(yaw));
    this.draw(this.frame);
  }

  zoom(factor) {
    this.eye.distance = Math.max(3, Math.min(3000, this.eye.distance * factor));
    this.draw(this.frame);
  }

  // Shows flights, the first one with its walk and bodies.
  show(town, flights, bodies) {
    this.shown = { town, flights, bodies: bodies && byFrame(bodies) };
    this.fit();
    this.rebuild();
    this.draw(this.frame);
  }

  fit() {
    const [flight] = this.shown ? this.shown.flights : [];
    if (!flight) return;
    const sides = ["x", "y", "z"].map(axis => [...flight[axis], ...flight[`target_${axis}`]].filter(it => it !== null));
    if (sides.some(numbers => !numbers.length)) return;
    const [x, y, z] = sides.map(numbers => (least(numbers) + most(numbers)) / 2);
    const wide = Math.max(SMALLEST_M / 2, ...sides.map(numbers => most(numbers) - least(numbers)));
    Object.assign(this.eye, { x, y, z, distance: 2 * wide });
    this.draw(this.frame);
  }

  // What stands still: ground, boxes near the flight, walk and flights.
  rebuild() {
    const mesh = [];
    const { town, flights } = this.shown;
    const [flight] = flights;
    const { x, y } = this.eye;
    const far = ([a, b]) => (a - x) ** 2 + (b - y) ** 2;
    const boxes = Object.entries(town.kinds).flatMap(([kind, numbers]) =>
      Array.from({ length: numbers.length / 7 }, (_, at) => [...numbers.slice(7 * at, 7 * at + 7), kind]));
    boxes.sort((a, b) => far(a) - far(b));
    for (const [bx, by, along, across, yaw, height, bottom, kind] of boxes.slice(0, MOST_SOLID)) {
      solid(mesh, [bx, by, bottom], [along, across, height], yaw, rgbOf(KIND_COLOURS[kind] || "#8b8f9a"));
    }
    if (flight && flight.x.length) {
      const ground = least(flight.target_z) - 0.1;
      solid(mesh, [x, y, ground - 1], [2000, 2000, 1], 0, rgbOf("#7f8a80"));
      ribbon(mesh, flight.target_x, flight.target_y, flight.target_z.map(z => z + 0.2), () => rgbOf("#d4006a"), 0.15);
    }
    flights.forEach((it, at) => ribbon(mesh, it.x, it.y, it.z, frame => shareColour(it.visible[frame] ?? 0), at === 0 ? 0.25 : 0.12));
    this.fill(this.still, mesh);
  }

  fill(part, mesh) {
    part.count = mesh.length / 6;
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, part.buffer);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, new Float32Array(mesh), this.gl.DYNAMIC_DRAW);
  }

  draw(frame) {
    this.frame = frame;
    const { gl, canvas } = this;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map(side => Math.round(side * ratio));
    if (!this.shown || !width || !height) return;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    gl.viewport(0, 0, width, height);
    const sky = getComputedStyle(document.body).backgroundColor.match(/[\d.]+/g).map(part => part / 255);
    gl.clearColor(sky[0], sky[1], sky[2], 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix4fv(gl.getUniformLocation(this.program, "view"), false, viewOf(this.eye, width / height));
    this.fill(this.moving, this.movers(frame));
    for (const part of [this.still, this.moving]) {
      gl.bindBuffer(gl.ARRAY_BUFFER, part.buffer);
      [["place", 0], ["colour", 12]].forEach(([name, offset]) => {
        const at = gl.getAttribLocation(this.program, name);
        gl.enableVertexAttribArray(at);
        gl.vertexAttribPointer(at, 3, gl.FLOAT, false, 24, offset);
      });
      gl.drawArrays(gl.TRIANGLES, 0, part.count);
    }
    canvas.dataset.frame = frame;
  }

  // Bodies, drones, targets and lines of sight of a frame.
  movers(frame) {
    const mesh = [];
    const { flights, bodies } = this.shown;
    const ground = flights.length ? flights[0].target_z[Math.min(frame, flights[0].x.length - 1)] : 0;
    for (const [kind, x, y, heading, length, width] of (bodies && bodies.get(frame)) || []) {
      const isPerson = kind === "pedestrian";
      solid(mesh, [x, y, ground], [Math.max(0.2, length / 2), Math.max(0.2, width / 2), isPerson ? 1.7 : 1.5], heading, rgbOf(isPerson ? "#7a3fb5" : "#3a5fa8"));
    }
    flights.forEach((flight, at) => {
      const last = Math.min(frame, flight.x.length - 1);
      const [drone, feet] = ["", "target_"].map(whose => ["x", "y", "z"].map(axis => flight[whose + axis][last]));
      solid(mesh, [drone[0], drone[1], drone[2] - 0.2], [0.5, 0.5, 0.4], flight.camera_yaw_deg[last], rgbOf(at === 0 ? "#1f5fb4" : "#c26b00"));
      solid(mesh, feet, [0.3, 0.3, 1.75], flight.heading_deg ? flight.heading_deg[last] : 0, rgbOf("#d4006a"));
      const seen = shareColour(flight.visible[last] ?? 0);
      ribbon(mesh, [drone[0], feet[0]], [drone[1], feet[1]], [drone[2], feet[2] + 1], () => seen, 0.05);
    });
    return mesh;
  }
}

// A box on its bottom: middle of the bottom, half lengths and height, metres. Its sides are shaded.
function solid(mesh, [x, y, z], [along, across, height], yawDegrees, colour) {
  const yaw = yawDegrees * Math.PI / 180;
  const corner = (a, b, up) => [x + a * along * Math.cos(yaw) - b * across * Math.sin(yaw), y + a * along * Math.sin(yaw) + b * across * Math.cos(yaw), z + up * height];
  const ring = [[1, 1], [-1, 1], [-1, -1], [1, -1]];
  quad(mesh, ring.map(([a, b]) => corner(a, b, 1)), colour);
  ring.forEach(([a, b], at) => {
    const [c, d] = ring[(at + 1) % 4];
    const shade = 0.7 + 0.15 * Math.cos(yaw + at * Math.PI / 2);
    quad(mesh, [corner(a, b, 0), corner(c, d, 0), corner(c, d, 1), corner(a, b, 1)], colour.map(part => shade * part));
  });
}

// A band along a path, lying and standing, so that it is seen from all sides.
function ribbon(mesh, xs, ys, zs, colourOf, half) {
  for (let at = 1; at < xs.length; at += 1) {
    const [dx, dy] = [xs[at] - xs[at - 1], ys[at] - ys[at - 1]];
    const length = Math.hypot(dx, dy) || 1;
    for (const [a, b, c] of [[-dy / length * half, dx / length * half, 0], [0, 0, half]]) {
      quad(mesh, [[at - 1, -1], [at, -1], [at, 1], [at - 1, 1]].map(([end, side]) => [xs[end] + side * a, ys[end] + side * b, zs[end] + side * c]), colourOf(at));
    }
  }
}

function quad(mesh, corners, colour) {
  for (const at of [0, 1, 2, 0, 2, 3]) mesh.push(...corners[at], ...colour);
}

// The matrix from the world to the picture. The world is left-handed: its y is turned round first.
function viewOf({ x, y, z, distance, yaw, pitch }, aspect) {
  const back = [Math.cos(pitch) * Math.cos(yaw), -Math.cos(pitch) * Math.sin(yaw), Math.sin(pitch)];
  const right = [Math.sin(yaw), Math.cos(yaw), 0];
  const up = [back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2], back[0] * right[1] - back[1] * right[0]];
  const eye = [x + distance * back[0], -y + distance * back[1], z + distance * back[2]];
  const along = axis => -axis.reduce((sum, part, at) => sum + part * eye[at], 0);
  // What stands right before the eye would hide everything.
  const [near, far, scale] = [0.3 * distance, 60 * distance + 3000, 1.7];
  const rows = [
    [...right, along(right)].map(part => part * scale / aspect),
    [...up, along(up)].map(part => part * scale),
    [...back, along(back)].map((part, at) => part * (far + near) / (near - far) + (at === 3 ? 2 * far * near / (near - far) : 0)),
    [...back, along(back)].map(part => -part),
  ];
  return new Float32Array([0, 1, 2, 3].flatMap(column => rows.map(row => column === 1 ? -row[column] : row[column])));
}

const rgbOf = hex => [1, 3, 5].map(at => parseInt(hex.slice(at, at + 2), 16) / 255);

// Red, through yellow, to green, as on the map.
function shareColour(share) {
  const part = Math.max(0, Math.min(1, share));
  return [Math.min(1, 2 - 2 * part) * 0.735, Math.min(1, 2 * part) * 0.735, 0.105];
}
