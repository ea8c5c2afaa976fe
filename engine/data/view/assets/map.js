// The map: town from above, walk, bodies and flights coloured by visibility. x points right, y down, as seen from above.
"use strict";

const KIND_COLOURS = {
  building: "#b89f8c", bridge: "#b89f8c", tree_crown: "#7ba86a88", treecrown: "#7ba86a88", bush: "#7ba86a88", vegetation: "#7ba86a88",
  tree_trunk: "#6b5640", wall: "#8d7668", fence: "#8d7668", car: "#7b86b8",
};
const SMALLEST_M = 40;
const SHADES = 10;
const REACH_PX = 12;

// Red where nothing is visible, through yellow to green.
const visibleColour = share => `hsl(${Math.round(130 * Math.max(0, Math.min(1, share)))} 75% 42%)`;

class TownMap {
  constructor(canvas, choose) {
    this.canvas = canvas;
    this.choose = choose;
    this.ground = document.createElement("canvas");
    this.view = { x: 0, y: 0, scale: 4 };
    this.shown = { town: { kinds: {} }, flights: [], bodies: null, frame: 0 };
    this.isStale = true;
    this.paths = null;
    let from = null;
    let isClick = false;
    canvas.addEventListener("pointerdown", event => {
      [from, isClick] = [[event.clientX, event.clientY], true];
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointerup", event => {
      if (isClick && this.paths) this.clicked(event.offsetX, event.offsetY);
      from = null;
    });
    canvas.addEventListener("pointermove", event => {
      if (!from) return;
      isClick = false;
      this.view.x -= (event.clientX - from[0]) / this.view.scale;
      this.view.y -= (event.clientY - from[1]) / this.view.scale;
      from = [event.clientX, event.clientY];
      this.moved();
    });
    canvas.addEventListener("wheel", event => { event.preventDefault(); this.zoom(Math.exp(-event.deltaY / 400)); }, { passive: false });
    canvas.addEventListener("keydown", event => {
      if (event.key === "+" || event.key === "-") this.zoom(event.key === "+" ? 1.3 : 1 / 1.3);
    });
    new ResizeObserver(() => this.moved()).observe(canvas);
  }

  zoom(factor) {
    this.view.scale = Math.max(0.05, Math.min(80, this.view.scale * factor));
    this.moved();
  }

  moved() {
    this.isStale = true;
    this.draw(this.shown.frame);
  }

  // Shows flights, the first one with its walk and bodies.
  show(town, flights, bodies) {
    Object.assign(this.shown, { town, flights, bodies: bodies && byFrame(bodies) });
    this.fit();
  }

  // Shows all flights of a town thinly, or none: for each its number, and x, y and the visible share of its points by turns.
  showPaths(paths) {
    this.paths = paths;
    this.fit();
  }

  fit() {
    const flights = this.shown.flights;
    const ofPaths = axis => (this.paths || []).flatMap(([, points]) => points.filter((_, at) => at % 3 === axis));
    const xs = [...flights.flatMap(it => [...it.x, ...it.target_x]), ...ofPaths(0)].filter(it => it !== null);
    const ys = [...flights.flatMap(it => [...it.y, ...it.target_y]), ...ofPaths(1)].filter(it => it !== null);
    if (!xs.length) return;
    const [left, right, top, bottom] = [least(xs), most(xs), least(ys), most(ys)];
    const wide = Math.max(SMALLEST_M, 1.3 * (right - left));
    const high = Math.max(SMALLEST_M, 1.3 * (bottom - top));
    this.view.x = (left + right) / 2;
    this.view.y = (top + bottom) / 2;
    this.view.scale = Math.min(this.canvas.clientWidth / wide, this.canvas.clientHeight / high) || 4;
    this.moved();
  }

  // Draws a frame: the ground from memory where the view has not changed.
  draw(frame) {
    this.shown.frame = frame;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight].map(side => Math.round(side * ratio));
    if (!width || !height) return;
    if (this.canvas.width !== width || this.canvas.height !== height) {
      [this.canvas, this.ground].forEach(it => { it.width = width; it.height = height; });
      this.isStale = true;
    }
    if (this.isStale) this.drawGround(this.ground.getContext("2d"), ratio);
    this.isStale = false;
    const context = this.canvas.getContext("2d");
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.drawImage(this.ground, 0, 0);
    this.place(context, ratio);
    this.drawBodies(context, frame);
    this.shown.flights.forEach((flight, at) => this.drawDrone(context, flight, frame, at));
    this.canvas.dataset.frame = frame;
  }

  place(context, ratio) {
    const { x, y, scale } = this.view;
    const [middle, centre] = [this.canvas.clientWidth / 2, this.canvas.clientHeight / 2];
    context.setTransform(scale * ratio, 0, 0, scale * ratio, (middle - x * scale) * ratio, (centre - y * scale) * ratio);
  }

  drawGround(context, ratio) {
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = getComputedStyle(document.body).backgroundColor;
    context.fillRect(0, 0, this.ground.width, this.ground.height);
    this.place(context, ratio);
    const reach = Math.max(this.canvas.clientWidth, this.canvas.clientHeight) / this.view.scale;
    for (const [kind, boxes] of Object.entries(this.shown.town.kinds)) {
      context.fillStyle = KIND_COLOURS[kind] || "#8b8f9a";
      for (let at = 0; at < boxes.length; at += 7) {
        const [x, y, along, across, yaw] = boxes.slice(at, at + 5);
        if (Math.abs(x - this.view.x) - along - across > reach || Math.abs(y - this.view.y) - along - across > reach) continue;
        rectangle(context, x, y, along, across, yaw);
      }
    }
    const pixel = 1 / this.view.scale;
    if (this.paths) this.drawPaths(context, 1.5 * pixel);
    const [flight] = this.shown.flights;
    if (!flight) return;
    context.strokeStyle = "#c0392b88";
    context.lineWidth = pixel;
    flight.crossings.forEach(outline => line(context, outline.filter((_, at) => at % 2 === 0), outline.filter((_, at) => at % 2), true));
    context.strokeStyle = getComputedStyle(document.body).color;
    context.setLineDash([4 * pixel, 4 * pixel]);
    context.lineWidth = 1.5 * pixel;
    line(context, flight.target_x, flight.target_y, false);
    context.setLineDash([]);
    this.shown.flights.slice().reverse().forEach(it => this.drawPath(context, it, it === flight ? 4 * pixel : 2 * pixel));
  }

  // All flights, colour by colour, the red ones on top.
  drawPaths(context, thickness) {
    context.lineWidth = thickness;
    for (let shade = SHADES; shade >= 0; shade -= 1) {
      context.strokeStyle = visibleColour(shade / SHADES);
      context.beginPath();
      for (const [, points] of this.paths) {
        for (let at = 3; at < points.length; at += 3) {
          if (Math.round(SHADES * points[at + 2]) !== shade) continue;
          context.moveTo(points[at - 3], points[at - 2]);
          context.lineTo(points[at], points[at + 1]);
        }
      }
      context.stroke();
    }
  }

  // Chooses the flight whose path passes a place of the canvas most closely.
  clicked(left, top) {
    const { x, y, scale } = this.view;
    const at = [x + (left - this.canvas.clientWidth / 2) / scale, y + (top - this.canvas.clientHeight / 2) / scale];
    let [nearest, closest] = [null, REACH_PX / scale];
    for (const [number, points] of this.paths) {
      for (let end = 3; end < points.length; end += 3) {
        const away = distanceFrom(at, points.slice(end - 3, end - 1), points.slice(end, end + 2));
        if (away < closest) [nearest, closest] = [number, away];
      }
    }
    if (nearest !== null) this.choose(nearest);
  }

  drawPath(context, flight, thickness) {
    context.lineWidth = thickness;
    for (let at = 1; at < flight.x.length; at += 1) {
      context.strokeStyle = visibleColour(flight.visible[at] ?? 0);
      line(context, flight.x.slice(at - 1, at + 1), flight.y.slice(at - 1, at + 1), false);
    }
  }

  drawBodies(context, frame) {
    for (const [kind, x, y, heading, length, width] of (this.shown.bodies && this.shown.bodies.get(frame)) || []) {
      context.fillStyle = kind === "pedestrian" ? "#7a3fb5" : "#3a5fa8";
      rectangle(context, x, y, Math.max(0.3, length / 2), Math.max(0.3, width / 2), heading);
    }
  }

  drawDrone(context, flight, frame, at) {
    const last = Math.min(frame, flight.x.length - 1);
    const [x, y, pixel] = [flight.x[last], flight.y[last], 1 / this.view.scale];
    const [feetX, feetY] = [flight.target_x[last], flight.target_y[last]];
    const colour = at === 0 ? "#1f5fb4" : "#c26b00";
    const yaw = flight.camera_yaw_deg[last] * Math.PI / 180;
    const half = (flight.fov_deg || 80) / 2 * Math.PI / 180;
    context.fillStyle = `${colour}33`;
    context.beginPath();
    context.moveTo(x, y);
    context.arc(x, y, 60 * pixel, yaw - half, yaw + half);
    context.fill();
    context.strokeStyle = visibleColour(flight.visible[last] ?? 0);
    context.lineWidth = 1.5 * pixel;
    line(context, [x, feetX], [y, feetY], false);
    disc(context, x, y, 6 * pixel, colour);
    disc(context, feetX, feetY, 5 * pixel, "#d4006a");
  }
}

function rectangle(context, x, y, along, across, yawDegrees) {
  const yaw = yawDegrees * Math.PI / 180;
  const [ax, ay, bx, by] = [along * Math.cos(yaw), along * Math.sin(yaw), -across * Math.sin(yaw), across * Math.cos(yaw)];
  context.beginPath();
  context.moveTo(x + ax + bx, y + ay + by);
  context.lineTo(x - ax + bx, y - ay + by);
  context.lineTo(x - ax - bx, y - ay - by);
  context.lineTo(x + ax - bx, y + ay - by);
  context.fill();
}

function line(context, xs, ys, isClosed) {
  context.beginPath();
  xs.forEach((x, at) => context.lineTo(x, ys[at]));
  if (isClosed) context.closePath();
  context.stroke();
}

function disc(context, x, y, radius, colour) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fillStyle = colour;
  context.fill();
  context.strokeStyle = "#fff";
  context.lineWidth = radius / 4;
  context.stroke();
}

// Distance of a place from the line between two others.
function distanceFrom([x, y], [fromX, fromY], [toX, toY]) {
  const [dx, dy] = [toX - fromX, toY - fromY];
  const share = Math.max(0, Math.min(1, ((x - fromX) * dx + (y - fromY) * dy) / (dx * dx + dy * dy || 1)));
  return Math.hypot(x - fromX - share * dx, y - fromY - share * dy);
}

// Bodies by their frames.
function byFrame(bodies) {
  const frames = new Map();
  for (const [kind, numbers] of Object.entries(bodies.kinds)) {
    for (let at = 0; at < numbers.length; at += 7) {
      if (!frames.has(numbers[at])) frames.set(numbers[at], []);
      frames.get(numbers[at]).push([kind, ...numbers.slice(at + 1, at + 6)]);
    }
  }
  return frames;
}

const least = numbers => numbers.reduce((a, b) => Math.min(a, b));
const most = numbers => numbers.reduce((a, b) => Math.max(a, b));
