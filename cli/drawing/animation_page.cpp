#include "cli/drawing/animation.hpp"
#include "cli/drawing/page_with_data.hpp"

namespace cli::inline drawings {
namespace {

constexpr std::string_view motion_page_style = R"html(  body { max-width: 1000px; }
  canvas { width: 100%; height: auto; border: 1px solid #ccc; display: block; background: #fcfcfc; }
  #marks { position: relative; height: 16px; margin: 2px 8px 0; }
  #marks button { position: absolute; width: 5px; height: 14px; padding: 0; margin-left: -2px; border: 0; cursor: pointer; }
  #time { min-width: 9em; font-variant-numeric: tabular-nums; }
  #event { min-height: 1.4em; }
  .impact { background: #d55e00; } .contact { background: #e69f00; } .release { background: #009e73; }
  .accumulation { background: #882255; } .branch { background: #888; }
  #legend span { display: inline-block; width: 10px; height: 10px; margin: 0 4px 0 12px; }
)html";

constexpr std::string_view motion_page_body = R"html(<canvas id="scene" width="1000" height="560"></canvas>
<div id="bar">
  <button id="play">Play</button>
  <div id="line"><input id="scrubber" type="range" min="0" value="0" step="1" aria-label="time"><div id="marks"></div></div>
  <span id="time"></span>
  <label>speed <select id="speed"><option value="0.1">1/10</option><option value="0.25">1/4</option>
    <option value="1" selected>1</option><option value="4">4</option><option value="16">16</option></select></label>
</div>
<div id="event"></div>
<div id="legend"></div>
)html";

constexpr std::string_view motion_page_script =
    R"html(const motion = JSON.parse(document.getElementById("motion").textContent);
const frames = motion.frames, shapes = motion.shapes;
const byId = (id) => document.getElementById(id);
const canvas = byId("scene"), pen = canvas.getContext("2d"), scrubber = byId("scrubber");
const blue = "#0072b2", red = "#d55e00", grey = "#666", black = "#222";
byId("title").textContent = motion.title;
scrubber.max = frames.length - 1;
const first = frames[0].t, last = frames[frames.length - 1].t;
const isScene = shapes.length > 0;

// The part of the plane that the motion needs, and the largest force.
let box = [Infinity, Infinity, -Infinity, -Infinity], strongest = 0;
const take = (x, y, r) => {
  box = [Math.min(box[0], x - r), Math.min(box[1], y - r), Math.max(box[2], x + r), Math.max(box[3], y + r)];
};
const sizes = [];
for (const frame of frames) {
  const v = frame.values;
  for (const shape of shapes) {
    const n = shape.numbers;
    take(v[n[0]], v[n[1]], shape.kind === "circle" ? Math.abs(v[n[2]]) : 0);
    if (shape.kind === "segment") take(v[n[2]], v[n[3]], 0);
  }
  for (const a of frame.arrows) sizes.push(Math.hypot(a[3], a[4]));
}
// One impact must not make all other forces invisible: nine in ten are drawn to scale.
sizes.sort((a, b) => a - b);
strongest = sizes.length > 0 ? sizes[Math.floor(0.9 * (sizes.length - 1))] : 0;
// What never moves is drawn as ground.
const isGround = shapes.map((shape) =>
  shape.numbers.every((k) => frames.every((frame) => frame.values[k] === frames[0].values[k])));
const span = Math.max(box[2] - box[0], box[3] - box[1], 1e-12);
const low = motion.coordinates.map((_, i) => Math.min(...frames.map((f) => f.values[i])));
const high = motion.coordinates.map((_, i) => Math.max(...frames.map((f) => f.values[i])));
const mostSliders = 24;
// Few sliders need no large canvas.
if (!isScene) canvas.height = Math.min(560, 150 + 60 * motion.coordinates.length);

function drawScene(frame) {
  const w = canvas.width, h = canvas.height, margin = 60;
  const scale = Math.min((w - 2 * margin) / Math.max(box[2] - box[0], 0.02 * span),
                         (h - 2 * margin) / Math.max(box[3] - box[1], 0.02 * span));
  const X = (x) => w / 2 + scale * (x - (box[0] + box[2]) / 2);
  const Y = (y) => h / 2 - scale * (y - (box[1] + box[3]) / 2);
  const v = frame.values;
  pen.lineWidth = 2.5;
  const order = shapes.map((_, i) => i).sort((i, j) => isGround[j] - isGround[i]);
  for (const i of order) {
    const shape = shapes[i], n = shape.numbers;
    pen.strokeStyle = pen.fillStyle = isGround[i] ? grey : blue;
    pen.beginPath();
    if (shape.kind === "segment") {
      pen.moveTo(X(v[n[0]]), Y(v[n[1]]));
      pen.lineTo(X(v[n[2]]), Y(v[n[3]]));
      pen.stroke();
    } else if (shape.kind === "circle") {
      pen.arc(X(v[n[0]]), Y(v[n[1]]), Math.abs(v[n[2]]) * scale, 0, 2 * Math.PI);
      pen.globalAlpha = 0.12;
      pen.fill();
      pen.globalAlpha = 1;
      pen.stroke();
    } else {
      pen.arc(X(v[n[0]]), Y(v[n[1]]), 5, 0, 2 * Math.PI);
      pen.fill();
    }
  }
  pen.font = "12px system-ui, sans-serif";
  lines = [];
  words = [];
  drawScale(scale);
  for (const [a, x, y, fx, fy] of frame.arrows) {
    const size = Math.hypot(fx, fy), length = 90 * Math.min(1.3, size / strongest);
    arrow(X(x), Y(y), fx / size * length, -fy / size * length);
  }
  for (const shape of shapes) outline(shape, v, X, Y, scale);
  if (shapes.length <= 40) shapes.forEach((shape, i) => {
    nameShape(shape, isGround[i] ? grey : black, v, X, Y, scale);
  });
  if (motion.constraints.length <= 40) for (const [a, x, y, fx, fy] of frame.arrows) {
    const size = Math.hypot(fx, fy), length = 90 * Math.min(1.3, size / strongest);
    if (length < 1) continue;
    const ux = fx / size, uy = -fy / size, tx = X(x) + ux * length, ty = Y(y) + uy * length;
    const mx = tx - ux * length / 2, my = ty - uy * length / 2;
    writeBeside(motion.constraints[a], red, "force " + a, [[tx, ty, ux, uy], [tx, ty, -uy, ux], [tx, ty, uy, -ux], [mx, my, -uy, ux], [mx, my, uy, -ux]]);
  }
}

// Words stand on no other words and on no line where one of their places allows it, and stay where they stood in the
// frame before as long as that is as good.
let lines = [], words = [];
const stood = {};
function meets([ax, ay, bx, by], box) {
  let begin = 0, end = 1;
  for (const [from, step, low, high] of [[ax, bx - ax, box[0], box[2]], [ay, by - ay, box[1], box[3]]]) {
    if (step === 0 && (from < low || from > high)) return false;
    if (step === 0) continue;
    const a = (low - from) / step, b = (high - from) / step;
    begin = Math.max(begin, Math.min(a, b));
    end = Math.min(end, Math.max(a, b));
  }
  return begin <= end;
}
// places: [x, y, ux, uy], the point and the direction from it in which the words stand.
function writeBeside(text, colour, key, places) {
  const half = pen.measureText(text).width / 2;
  const boxes = places.map(([x, y, ux, uy]) => {
    // The box of the words touches what it names where its corner is 6 pixels off.
    const away = ux === 0 && uy === 0 ? 0 : 6 + Math.abs(ux) * half + Math.abs(uy) * 5;
    const mx = x + ux * away, my = y + uy * away;
    return [mx - half - 1, my - 6, mx + half + 1, my + 6];
  });
  const cost = (box) => lines.filter((line) => meets(line, box)).length +
    4 * words.filter((other) => box[0] < other[2] && other[0] < box[2] && box[1] < other[3] && other[1] < box[3]).length +
    (box[0] < 0 || box[1] < 0 || box[2] > canvas.width || box[3] > canvas.height ? 4 : 0);
  const costs = boxes.map(cost), least = Math.min(...costs), before = stood[key];
  const chosen = costs[before] === least ? before : costs.indexOf(least);
  stood[key] = chosen;
  const box = boxes[chosen];
  words.push(box);
  pen.fillStyle = colour;
  pen.textAlign = "center";
  pen.fillText(text, (box[0] + box[2]) / 2, (box[1] + box[3]) / 2 + 4);
  pen.textAlign = "left";
}
function outline(shape, v, X, Y, scale) {
  const n = shape.numbers, x = X(v[n[0]]), y = Y(v[n[1]]), corners = 16;
  if (shape.kind === "segment") lines.push([x, y, X(v[n[2]]), Y(v[n[3]])]);
  if (shape.kind === "point") lines.push([x - 5, y, x + 5, y]);
  const r = shape.kind === "circle" ? Math.abs(v[n[2]]) * scale : 0, turn = 2 * Math.PI / corners;
  for (let k = 0; k < corners && r > 0; ++k)
    lines.push([x + r * Math.cos(k * turn), y + r * Math.sin(k * turn),
                x + r * Math.cos((k + 1) * turn), y + r * Math.sin((k + 1) * turn)]);
}

// Beside a rod, best at its middle and on the side that looks up; in a circle or around it; around a point.
function nameShape(shape, colour, v, X, Y, scale) {
  const n = shape.numbers, x = X(v[n[0]]), y = Y(v[n[1]]), places = [];
  if (shape.kind === "segment") {
    const dx = X(v[n[2]]) - x, dy = Y(v[n[3]]) - y, length = Math.hypot(dx, dy);
    let nx = length > 0 ? dy / length : 0, ny = length > 0 ? -dx / length : -1;
    if (ny > 0 || (ny === 0 && nx < 0)) { nx = -nx; ny = -ny; }
    for (const part of [1 / 2, 1 / 3, 2 / 3, 1 / 6, 5 / 6])
      for (const side of [1, -1]) places.push([x + part * dx, y + part * dy, side * nx, side * ny]);
  } else {
    const r = shape.kind === "circle" ? Math.abs(v[n[2]]) * scale : 4, slant = Math.SQRT1_2;
    if (shape.kind === "circle" && r > 14) places.push([x, y, 0, 0]);
    for (const [ux, uy] of [[slant, -slant], [0, -1], [1, 0], [-1, 0], [0, 1]]) places.push([x + r * ux, y + r * uy, ux, uy]);
  }
  writeBeside(shape.name, colour, "shape " + shape.name, places);
}

// A length of 1, 2 or 5 times a power of ten, in the units of the file.
function drawScale(scale) {
  const power = Math.pow(10, Math.floor(Math.log10(200 / scale)));
  const unit = [5, 2, 1].find((k) => k * power * scale <= 200) * power;
  const right = canvas.width - 16, left = right - unit * scale, y = canvas.height - 14;
  pen.strokeStyle = pen.fillStyle = black;
  pen.lineWidth = 1;
  pen.beginPath();
  pen.moveTo(left, y - 5);
  pen.lineTo(left, y);
  pen.lineTo(right, y);
  pen.lineTo(right, y - 5);
  pen.stroke();
  pen.textAlign = "center";
  pen.fillText(Number(unit.toPrecision(1)).toString(), (left + right) / 2, y - 5);
  pen.textAlign = "left";
  words.push([left, y - 16, right, y]);
}

function arrow(x, y, dx, dy) {
  const length = Math.hypot(dx, dy);
  if (length < 1) return;
  const ux = dx / length, uy = dy / length, tip = Math.min(9, length);
  pen.strokeStyle = pen.fillStyle = red;
  pen.lineWidth = 2;
  pen.beginPath();
  pen.moveTo(x, y);
  pen.lineTo(x + dx - ux * tip, y + dy - uy * tip);
  pen.stroke();
  pen.beginPath();
  pen.moveTo(x + dx, y + dy);
  pen.lineTo(x + dx - ux * tip - uy * tip / 2, y + dy - uy * tip + ux * tip / 2);
  pen.lineTo(x + dx - ux * tip + uy * tip / 2, y + dy - uy * tip - ux * tip / 2);
  pen.fill();
  lines.push([x, y, x + dx, y + dy]);
}

function drawSliders(frame) {
  const count = Math.min(mostSliders, motion.coordinates.length), right = canvas.width - 150;
  pen.font = "14px system-ui, sans-serif";
  const widest = Math.max(...motion.coordinates.slice(0, count).map((name) => pen.measureText(name).width));
  const left = Math.min(Math.max(140, widest + 30), canvas.width / 2);
  pen.fillStyle = "#222";
  if (count < motion.coordinates.length) pen.fillText("the first " + count + " of " + motion.coordinates.length + " coordinates", 10, 16);
  for (let i = 0; i < count; ++i) {
    const y = 30 + i * Math.min(60, (canvas.height - 120) / count), range = high[i] - low[i];
    const x = range > 0 ? left + (right - left) * (frame.values[i] - low[i]) / range : (left + right) / 2;
    pen.strokeStyle = "#bbb";
    pen.lineWidth = 3;
    pen.beginPath();
    pen.moveTo(left, y);
    pen.lineTo(right, y);
    pen.stroke();
    pen.fillStyle = blue;
    pen.beginPath();
    pen.arc(x, y, 8, 0, 2 * Math.PI);
    pen.fill();
    pen.fillStyle = "#222";
    pen.fillText(motion.coordinates[i], 10, y + 5, left - 30);
    pen.fillText(frame.values[i].toPrecision(5), right + 20, y + 5);
  }
}

// Forces that act on no place that is drawn stand as numbers. Of very many, the strongest are drawn.
function drawForces(frame) {
  const drawn = new Set(frame.arrows.map((a) => a[0]));
  const others = frame.forces_left_out > 0 ? [] : frame.lambda.filter(([a]) => !drawn.has(a));
  pen.fillStyle = red;
  pen.font = "13px system-ui, sans-serif";
  if (frame.forces_left_out > 0)
    pen.fillText(drawn.size + " of " + frame.lambda.length + " forces are drawn, the strongest", 10, canvas.height - 12);
  if (others.length > 8) pen.fillText("and " + (others.length - 8) + " more", 10, canvas.height - 12 - 16 * 8);
  others.slice(0, 8).forEach(([a, lambda], k) => pen.fillText("lambda[" + motion.constraints[a] + "] = " + lambda.toPrecision(5),
                                                 10, canvas.height - 12 - 16 * k));
}

let now = 0;
function show(k) {
  now = Math.max(0, Math.min(frames.length - 1, k));
  const frame = frames[now];
  pen.clearRect(0, 0, canvas.width, canvas.height);
  isScene ? drawScene(frame) : drawSliders(frame);
  drawForces(frame);
  scrubber.value = now;
  byId("time").textContent = "t = " + frame.t.toPrecision(6);
  const before = motion.events.filter((e) => e.t <= frame.t);
  byId("event").textContent = before.length === 0 ? "" : told(before[before.length - 1]);
}
const told = (e) => e.kind + " at t = " + e.t.toPrecision(8) + (e.constraints.length === 0 ? "" :
  ": " + e.constraints.map((a) => motion.constraints[a]).join(", "));
function frameAt(t) {
  let k = 0;
  while (k < frames.length - 1 && frames[k].t < t) ++k;
  return k;
}
for (const e of motion.events) {
  const mark = document.createElement("button");
  mark.className = e.kind;
  mark.title = told(e);
  mark.style.left = (last > first ? 100 * (e.t - first) / (last - first) : 0) + "%";
  mark.onclick = () => { stop(); show(frameAt(e.t)); };
  byId("marks").append(mark);
}
for (const kind of new Set(motion.events.map((e) => e.kind))) {
  const swatch = document.createElement("span");
  swatch.className = kind;
  byId("legend").append(swatch, kind);
}
if (motion.events_left_out > 0) byId("legend").append("; " + motion.events_left_out + " more events are not marked");

let timer = null, begun = 0, from = 0;
function stop() {
  if (timer !== null) cancelAnimationFrame(timer);
  timer = null;
  byId("play").textContent = "Play";
}
function tick(clock) {
  const t = from + (clock - begun) / 1000 * Number(byId("speed").value);
  show(t >= last ? frames.length - 1 : frameAt(t));
  if (t >= last) return stop();
  timer = requestAnimationFrame(tick);
}
byId("play").onclick = () => {
  if (timer !== null) return stop();
  from = now === frames.length - 1 ? first : frames[now].t;
  begun = performance.now();
  byId("play").textContent = "Pause";
  timer = requestAnimationFrame(tick);
};
byId("speed").onchange = () => { from = frames[now].t; begun = performance.now(); };
scrubber.oninput = () => { stop(); show(Number(scrubber.value)); };
show(0);
document.body.dataset.ready = "yes";
)html";

}  // namespace

std::string animation_page(const std::string& title, const std::string& data) {
  return page_with_data({"motion", motion_page_style, motion_page_body, motion_page_script}, title, data);
}

}  // namespace cli::inline drawings
