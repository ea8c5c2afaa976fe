// The page: what is chosen, and how it is shown.
"use strict";

const $ = id => document.getElementById(id);
const state = { index: null, flight: null, beside: null, frame: 0, isPlaying: false };
const map = new TownMap($("map"), number => choose(number));
const scene = new Scene($("scene"));
const pictures = new Pictures($("pictures"));
const LEGEND = $("legend").textContent;
let list;

const element = (name, text) => Object.assign(document.createElement(name), { textContent: text });
const row = (name, value) => {
  const line = document.createElement("tr");
  line.append(Object.assign(element("th", name), { scope: "row" }), element("td", value));
  return line;
};

// A number of things: `1 flight`, `2 flights`.
const counted = (number, noun) => `${number} ${noun}${number === 1 ? "" : "s"}`;

async function start() {
  // The token has done its work: it must not stay in the address.
  if (location.search) history.replaceState(null, "", location.pathname + location.hash);
  const [about, index] = await Promise.all([source.get("/api/about"), source.get("/api/index")]);
  state.about = about;
  source.setVersion(about.version);
  document.title = `${about.name} – cosfly view`;
  $("name").textContent = about.name;
  const left = about.shown < about.flights ? `, the first ${about.shown} in the list` : "";
  const rejected = about.rejected ? `, ${about.rejected} without a flight` : "";
  $("about").textContent = `${about.kind}: ${counted(about.flights, "flight")}${left}${rejected}` + (source.isExported ? ", an exported page" : "");
  state.index = index;
  list = new FlightList(state.index, flight => choose(flight));
  for (const column of state.index.columns) {
    $("columns").append(element("dt", column.name), element("dd", column.doc));
    $("sort").append(Object.assign(element("option", column.name), { value: column.name }));
  }
  filter();
  $("list").hidden = !state.index.flights;
  if (about.kind === "recipe" && !source.isExported) progress();
  await followLink() || (list.order.length && await choose(list.order[0]));
}

function filter() {
  const words = $("matches");
  try {
    const lets = filterOf($("query").value, state.index);
    list.show(lets, $("sort").value);
    words.className = "";
    words.textContent = list.order.length ? `${list.order.length} of ${counted(state.index.flights, "flight")}`
      : state.index.flights ? "no flight is like this" : withoutFlights();
  } catch (error) {
    words.className = "wrong";
    words.textContent = error.message;
  }
}

// Words for a list that has nothing.
function withoutFlights() {
  const { kind, reasons } = state.about;
  return kind === "recipe" ? "there are no flights yet" : (reasons || [`this ${kind} has no flights`]).join("\n");
}

// The number of the flight that was asked for last: answers to earlier questions come too late.
let asked = null;

async function choose(number, frame) {
  asked = number;
  list.mark(number);
  $("flight").hidden = false;
  try {
    const flight = await load(number);
    if (asked !== number) return;
    state.flight = flight;
    state.beside = null;
    pictures.isOpening = true;
    const longest = flight.losses.reduce((a, b) => b.end - b.from > a.end - a.from ? b : a, { from: 0, end: 0 });
    const worst = list.value("worst_frame", number) ?? longest.from;
    showFlight();
    setFrame(frame ?? worst);
    const partner = flight.family.find(it => it.number !== number && source.has(it.number));
    await compare(partner ? partner.number : null);
  } catch (error) {
    if (asked !== number) return;
    if (!state.flight || state.flight.number !== number) showNone(number);
    tell(error.message);
  } finally {
    if (asked === number) pictures.isOpening = false;
  }
}

// A flight that cannot be loaded: the one before must not stand below its message.
function showNone(number) {
  state.flight = null;
  clearTimeout(linkTimer);
  showParts(false);
  $("title").textContent = list.value("name", number) || "";
  $("reason").textContent = list.value("reason", number) || "";
}

function showParts(isShown) {
  for (const part of ["views", "texts", "strip"]) $(part).hidden = !isShown;
}

const loaded = new Map();
async function load(number) {
  if (!loaded.has(number)) {
    // An exported page holds towns by their names, which the flight tells.
    const told = source.get(`/api/flight/${number}`);
    const places = source.isExported ? told.then(it => source.town(number, it.town)) : source.town(number);
    const [flight, town, bodies] = await Promise.all([told, places, source.get(`/api/bodies/${number}`)]);
    flight.number = number;
    flight.boxes = new Map();
    bodies.boxes.forEach(([frame, , edges]) => flight.boxes.set(frame, [...(flight.boxes.get(frame) || []), edges]));
    Object.assign(flight, { boxesOfTown: town, bodies });
    loaded.set(number, flight);
    if (loaded.size > 12) loaded.delete(loaded.keys().next().value);
  }
  return loaded.get(number);
}

function tell(message) {
  $("problem").hidden = !message;
  $("problem").textContent = message || "";
}

function showFlight() {
  const flight = state.flight;
  const problem = flight.problem;
  showParts(true);
  tell(problem && [problem.message, ...problem.causes, ...problem.hints].join("\n"));
  $("title").textContent = flight.name;
  $("reason").textContent = flight.reason || list.value("reason", flight.number) || "";
  $("frame").max = Math.max(0, flight.x.length - 1);
  $("facts").replaceChildren(...flight.facts.map(([name, value]) => row(name, value)));
  $("beside").replaceChildren(Object.assign(element("option", "nothing"), { value: "" }), ...flight.family
    .filter(it => it.number !== flight.number && source.has(it.number))
    .map(it => Object.assign(element("option", it.name), { value: it.number })));
  $("losses").replaceChildren(...flight.losses.map(loss => {
    const item = document.createElement("li");
    const button = element("button", `frames ${loss.from} to ${loss.end - 1}, ${((loss.end - loss.from) * flight.dt_s).toFixed(1)} s: ${loss.cause}`);
    button.type = "button";
    button.addEventListener("click", () => setFrame(loss.from));
    item.append(button);
    return item;
  }));
  const left = flight.bodies.left_out + flight.boxesOfTown.left_out;
  $("legend").textContent = LEGEND + (left > 0 ? ` ${left} boxes and bodies are not drawn.` : "");
  if (!flight.losses.length) $("losses").replaceChildren(element("li", "none"));
  showPlaces();
  pictures.show(flight, null);
}

async function compare(number) {
  const flight = state.flight;
  if (!flight) return;
  $("beside").value = number === null ? "" : String(number);
  const beside = number === null ? null : await load(number);
  if (state.flight !== flight) return;
  state.beside = beside;
  showPlaces();
  pictures.show(flight, beside);
  setFrame(state.frame);
}

// The town with the flights, on the map and, where it is shown, in 3-D.
function showPlaces() {
  const { flight, beside } = state;
  const flights = beside ? [flight, beside] : [flight];
  map.show(flight.boxesOfTown, flights, flight.bodies);
  if (!$("scene").hidden) scene.show(flight.boxesOfTown, flights, flight.bodies);
  if (isPressed($("all")) && !(map.paths && flight.town === state.pathsOf)) showPaths();
}

// All flights of the town that is shown.
async function showPaths() {
  const { flight } = state;
  try {
    const { flights } = await source.get(`/api/paths/${flight.number}`);
    // Answers may come too late: another town, no flight, or the button released.
    if (state.flight?.town !== flight.town || !isPressed($("all"))) return;
    state.pathsOf = flight.town;
    map.showPaths(flights);
  } catch (error) {
    tell(error.message);
  }
}

function toggleAll() {
  const isShown = toggle($("all"));
  if (isShown && $("map").hidden) toggleSolid();
  return isShown ? showPaths() : map.showPaths(null);
}

function toggleSolid() {
  const isSolid = toggle($("solid"));
  $("map").hidden = isSolid;
  $("scene").hidden = !isSolid;
  if (isSolid && isPressed($("all"))) toggleAll();
  showPlaces();
  $("fit").title = isSolid ? "Drag turns, Shift and drag moves, the wheel zooms" : "";
  setFrame(state.frame);
}

const isPressed = button => button.getAttribute("aria-pressed") === "true";

function toggle(button) {
  button.setAttribute("aria-pressed", String(!isPressed(button)));
  return isPressed(button);
}

let isDue = false;
function setFrame(frame) {
  if (!state.flight) return;
  state.frame = Math.max(0, Math.min(state.flight.x.length - 1, Number(frame) || 0));
  $("frame").value = state.frame;
  if (!isDue) requestAnimationFrame(draw);
  isDue = true;
}

function draw() {
  isDue = false;
  const { flight, frame } = state;
  if (!flight) return;
  const at = name => flight[name] && flight[name][frame];
  map.draw(frame);
  if (!$("scene").hidden) scene.draw(frame);
  pictures.draw(frame);
  drawStrip();
  $("time").textContent = `${frame} of ${flight.x.length - 1}, ${(at("time_s") ?? 0).toFixed(2)} s`;
  const numbers = ["visible", "visible_by_rays", "distance_m", "clearance_m", "target_speed_mps", "x", "y", "z", "camera_yaw_deg",
    "camera_pitch_deg", "look_alikes", "tracked", "expert_frame"];
  const shown = numbers.filter(name => at(name) !== undefined && at(name) !== null);
  $("numbers").replaceChildren(...shown.map(name => row(name, String(at(name)))));
  const goals = (flight.goals || []).filter(goal => goal.from <= frame && frame < goal.end);
  $("words").replaceChildren(
    ...goals.flatMap(goal => paragraph(`goal, ${goal.language}, ${goal.grain}${goal.fits ? "" : ", does not fit"}`, goal.lines.join(" – "))),
    ...(flight.captions || []).flatMap(caption => paragraph(`${caption.language}, ${caption.style}, ${caption.writer}`, caption.text)));
  clearTimeout(linkTimer);
  linkTimer = setTimeout(writeLink, 200);
}

// The address leads to the frame; browsers take few changes of it in a second.
let linkTimer;
function writeLink() {
  const { flight, frame } = state;
  history.replaceState(null, "", `#flight=${encodeURIComponent(flight.name)}&frame=${frame}&number=${flight.number}`);
}

function paragraph(about, text) {
  const words = document.createElement("p");
  words.append(element("small", about), text);
  words.dir = "auto";
  return words;
}

// The visible share over time; red where the target is lost.
function drawStrip() {
  const { flight, frame } = state;
  const canvas = $("strip");
  const width = canvas.width = canvas.clientWidth;
  const context = canvas.getContext("2d");
  const step = width / Math.max(1, flight.x.length);
  context.clearRect(0, 0, width, 36);
  flight.visible.forEach((share, at) => {
    context.fillStyle = visibleColour(share ?? 0);
    context.fillRect(at * step, 36 - 32 * (share ?? 0), Math.ceil(step), 36);
  });
  context.fillStyle = "#d0202088";
  flight.losses.forEach(loss => context.fillRect(loss.from * step, 0, Math.ceil((loss.end - loss.from) * step), 36));
  context.fillStyle = getComputedStyle(document.body).color;
  context.fillRect((frame + 0.5) * step - 1, 0, 2, 36);
}

// `#flight=NAME&frame=N`; the number tells flights of one name apart.
async function followLink(hash = location.hash) {
  clearTimeout(linkTimer);
  const asked = new URLSearchParams(hash.slice(1));
  const names = (state.index.columns.find(column => column.name === "name") || { texts: [] }).texts;
  const number = Number(asked.get("number"));
  const flight = names[number] === asked.get("flight") ? number : names.indexOf(asked.get("flight"));
  if (!asked.get("flight") || flight < 0) return false;
  await choose(flight, asked.get("frame"));
  return true;
}

// First pictures of films that a recipe has so far; loaded again only where there are others.
let filmsShown = "[]";
function showFilms(films) {
  if (JSON.stringify(films) === filmsShown) return;
  filmsShown = JSON.stringify(films);
  $("films").replaceChildren(...films.map(film => {
    const figure = document.createElement("figure");
    const address = `/picture/${film.number}/0/rgb?v=${film.version}`;
    figure.append(Object.assign(new Image(), { src: address, alt: `first picture of ${film.name}` }), element("figcaption", film.name));
    return figure;
  }));
}

async function progress() {
  $("progress").hidden = false;
  try {
    const { stages, films } = (await source.get("/api/progress")) || { stages: [], films: [] };
    $("stages").replaceChildren(...stages.map(stage => {
      const line = row(`${stage.name} (${stage.kind})`, String(stage.made));
      line.append(element("td", String(stage.items)), element("td", stage.failures.join("; ")));
      return line;
    }));
    showFilms(films);
    const left = stages.reduce((sum, stage) => sum + stage.to_run, 0);
    $("ready").textContent = !stages.length ? "nothing is made yet: start `cosfly run`"
      : left ? left === 1 ? "1 task is left" : `${left} tasks are left` : "everything is made: reload to see its flights once `cosfly run` has ended";
  } catch (error) {
    $("ready").textContent = error.message;
  }
  setTimeout(progress, 2000);
}

function play() {
  state.isPlaying = !state.isPlaying;
  $("play").textContent = state.isPlaying ? "Pause" : "Play";
  const tick = () => {
    if (!state.isPlaying || !state.flight) return;
    if (state.frame + 1 >= state.flight.x.length) return play();
    setFrame(state.frame + 1);
    setTimeout(tick, Math.max(30, 1000 * state.flight.dt_s));
  };
  if (state.isPlaying) tick();
}

function nextLoss() {
  const losses = state.flight ? state.flight.losses : [];
  const next = losses.find(loss => loss.from > state.frame) || losses[0];
  if (next) setFrame(next.from);
}

const KEYS = {
  ArrowLeft: event => setFrame(state.frame - (event.shiftKey ? 10 : 1)),
  ArrowRight: event => setFrame(state.frame + (event.shiftKey ? 10 : 1)),
  ArrowUp: () => list.step(-1),
  ArrowDown: () => list.step(1),
  Home: () => setFrame(0),
  End: () => setFrame(Infinity),
  " ": play,
  l: nextLoss,
  t: theme,
  "/": () => $("query").focus(),
};

function theme() {
  const isDark = getComputedStyle(document.documentElement).colorScheme === "dark"
    || document.documentElement.dataset.theme === undefined && matchMedia("(prefers-color-scheme: dark)").matches;
  document.documentElement.dataset.theme = isDark ? "light" : "dark";
  map.moved();
  if (!$("scene").hidden) scene.draw(state.frame);
  if (state.flight) drawStrip();
}

document.addEventListener("keydown", event => {
  const isTyping = event.target.matches("input[type=search], select");
  if (event.key === "Escape") event.target.blur();
  if (isTyping || event.ctrlKey || event.metaKey || event.altKey || !(event.key in KEYS) || !list) return;
  if (event.key === " " && event.target.matches("button, summary")) return;
  event.preventDefault();
  KEYS[event.key](event);
});
$("query").addEventListener("input", filter);
$("sort").addEventListener("change", filter);
$("frame").addEventListener("input", event => setFrame(event.target.value));
$("strip").addEventListener("click", event => setFrame(Math.floor(event.offsetX / $("strip").clientWidth * state.flight.x.length)));
$("beside").addEventListener("change", event => compare(event.target.value === "" ? null : Number(event.target.value)).catch(error => tell(error.message)));
$("play").addEventListener("click", play);
$("fit").addEventListener("click", () => ($("scene").hidden ? map : scene).fit());
$("all").addEventListener("click", toggleAll);
$("solid").addEventListener("click", toggleSolid);
$("solid").hidden = !scene.isThere;
$("all").hidden = source.isExported;
$("theme").addEventListener("click", theme);
// The address itself may have been written over meanwhile.
window.addEventListener("hashchange", event => followLink(new URL(event.newURL).hash));
start().catch(error => { $("about").textContent = error.message; });
