#include "cli/drawing/liquid_animation.hpp"
#include "cli/drawing/page_with_data.hpp"

namespace cli::inline drawings {
namespace {

constexpr std::string_view liquid_page_style = R"html(  body { max-width: 900px; }
  canvas { width: 100%; height: auto; display: block; }
  #marks { position: relative; height: 18px; margin: 2px 8px 0; }
  #marks button { position: absolute; width: 5px; height: 14px; padding: 0; margin-left: -2px; border: 0; background: #d55e00; cursor: pointer; }
  #value { min-width: 10em; font-variant-numeric: tabular-nums; }
  #state { min-height: 1.4em; }
)html";

constexpr std::string_view liquid_page_body = R"html(<canvas id="scene" width="900" height="620"></canvas>
<div id="bar">
  <button id="play">Play</button>
  <div id="line"><input id="scrubber" type="range" min="0" value="0" step="1" aria-label="parameter"><div id="marks"></div></div>
  <span id="value"></span>
  <label>speed <select id="speed"><option value="2">slow</option><option value="8" selected>middle</option>
    <option value="24">fast</option></select></label>
  <label><input id="own" type="checkbox"> own scale</label>
</div>
<div id="state"></div>
)html";

constexpr std::string_view liquid_page_script =
    R"html(const liquid = JSON.parse(document.getElementById("liquid").textContent);
const frames = liquid.frames, byId = (id) => document.getElementById(id);
const canvas = byId("scene"), pen = canvas.getContext("2d"), scrubber = byId("scrubber");
byId("title").textContent = liquid.title;
scrubber.max = frames.length - 1;

// Numbers of two bytes, the low one first.
function codes(letters) {
  const bytes = atob(letters), numbers = new Uint16Array(bytes.length / 2);
  for (let k = 0; k < numbers.length; ++k) numbers[k] = bytes.charCodeAt(2 * k) + 256 * bytes.charCodeAt(2 * k + 1);
  return numbers;
}
let level = null;
for (const frame of frames) {
  if (frame.failure !== undefined) continue;
  frame.codes = codes(frame.p);
  if (frame.level !== null) level = codes(frame.level);
  frame.levels = level;
}
const blues = [[255, 255, 255], [198, 219, 239], [107, 174, 214], [33, 113, 181]], stops = [0, 0.3, 0.7, 1];
function colour(part) {
  let k = 0;
  while (k < 2 && part > stops[k + 1]) ++k;
  const w = Math.min(1, (part - stops[k]) / (stops[k + 1] - stops[k]));
  return [0, 1, 2].map((i) => (1 - w) * blues[k][i] + w * blues[k + 1][i]);
}
const palette = Array.from({length: 1025}, (_, k) => colour(k / 1024));
const cavity = liquid.cavity_code, most = liquid.most_code;
// The pressure at the top of the scale: of all pictures, or of each its own.
const scaleTop = (frame) => byId("own").checked ? frame.largest : liquid.largest;
const contours = 12, margin = {left: 70, right: 110, top: 14, bottom: 46};
const shown = (x) => Number(x.toPrecision(5)).toString();

// Multiples of 1, 2 or 5 times a power of ten, four to eight of them.
function ticks(low, high) {
  const rough = (high - low) / 6, decade = 10 ** Math.floor(Math.log10(rough));
  const step = decade * [1, 2, 5, 10].find((k) => k * decade >= rough);
  const all = [];
  for (let k = Math.ceil(low / step - 1e-9); k <= high / step + 1e-9; ++k) all.push(k * step);
  return all;
}

function axes(x0, y0, w, h, box, names) {
  pen.strokeStyle = "#444";
  pen.lineWidth = 1;
  pen.strokeRect(x0, y0, w, h);
  pen.fillStyle = "#222";
  pen.font = "13px system-ui, sans-serif";
  pen.textAlign = "center";
  for (const x of ticks(box[0], box[1])) pen.fillText(shown(x), x0 + w * (x - box[0]) / (box[1] - box[0]), y0 + h + 18);
  pen.textAlign = "right";
  for (const y of ticks(box[2], box[3])) pen.fillText(shown(y), x0 - 6, y0 + h - h * (y - box[2]) / (box[3] - box[2]) + 4);
  pen.textAlign = "center";
  pen.fillText(names[0], x0 + w / 2, y0 + h + 38);
  pen.textAlign = "left";
  pen.fillText(names[1], Math.max(4, x0 - 62), y0 + h / 2);
}

// The pressure pixel by pixel, linear between the points of the frame.
function drawPlane(frame) {
  const [nx, ny] = frame.points, box = frame.box;
  const scale = Math.min((canvas.width - margin.left - margin.right) / (box[1] - box[0]),
                         (canvas.height - margin.top - margin.bottom) / (box[3] - box[2]));
  const w = Math.max(2, Math.round(scale * (box[1] - box[0]))), h = Math.max(2, Math.round(scale * (box[3] - box[2])));
  const x0 = Math.round(margin.left + (canvas.width - margin.left - margin.right - w) / 2), y0 = margin.top;
  const image = pen.createImageData(w, h), bands = new Int16Array(w * h), {codes, levels} = frame;
  const zoom = liquid.largest / (scaleTop(frame) || 1);
  for (let row = 0; row < h; ++row) {
    const y = (h - 1 - row) / (h - 1) * (ny - 1), j = Math.min(ny - 2, Math.floor(y)), b = y - j;
    for (let column = 0; column < w; ++column) {
      const x = column / (w - 1) * (nx - 1), i = Math.min(nx - 2, Math.floor(x)), a = x - i;
      const k = j * nx + i, ends = [k, k + 1, k + nx, k + nx + 1];
      const weights = [(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b];
      let p = 0, empty = 0, outside = 0;
      for (let e = 0; e < 4; ++e) {
        const code = codes[ends[e]];
        outside += weights[e] * (levels[ends[e]] - 32768);
        if (code > most) empty += weights[e] * (code - most) / (cavity - most); else p += weights[e] * code / most;
      }
      p *= zoom;
      const here = row * w + column;
      if (outside > 1) { bands[here] = -2; continue; }
      const isEmpty = empty > 0.5;
      bands[here] = isEmpty ? -1 : Math.floor(p * contours);
      const rgb = isEmpty ? ((row + column) % 9 < 2 ? [90, 90, 90] : [245, 245, 245])
                          : palette[Math.round(1024 * Math.min(1, p))];
      image.data.set([rgb[0], rgb[1], rgb[2], 255], 4 * here);
    }
  }
  for (let row = 0; row + 1 < h; ++row)
    for (let column = 0; column + 1 < w; ++column) {
      const here = row * w + column, band = bands[here];
      for (const there of [here + 1, here + w])
        if (band !== bands[there] && band > -2 && bands[there] > -2)
          image.data.set([80, 80, 80, 255], 4 * here);
    }
  pen.putImageData(image, x0, y0);
  axes(x0, y0, w, h, box, frame.coordinates);
  pen.fillStyle = "#d00000";
  for (const [x, y] of frame.parted) {
    pen.beginPath();
    pen.arc(x0 + scale * (x - box[0]), y0 + h - scale * (y - box[2]), 3, 0, 2 * Math.PI);
    pen.fill();
  }
  const left = canvas.width - margin.right + 24;
  for (let row = 0; row < h; ++row) {
    pen.fillStyle = "rgb(" + palette[Math.round(1024 * (h - 1 - row) / (h - 1))].map(Math.round).join(",") + ")";
    pen.fillRect(left, y0 + row, 16, 1);
  }
  pen.strokeStyle = "#444";
  pen.strokeRect(left, y0, 16, h);
  pen.fillStyle = "#222";
  for (let k = 0; k <= 4; ++k) pen.fillText(shown(scaleTop(frame) * k / 4), left + 21, y0 + h - h * k / 4 + (k === 4 ? 10 : 4));
  pen.fillText("p", left + 4, y0 + h + 18);
}

function drawLine(frame) {
  const box = [frame.box[0], frame.box[1], 0, scaleTop(frame) * 1.05 || 1], n = frame.points[0];
  const zoom = liquid.largest / (scaleTop(frame) || 1);
  const w = canvas.width - margin.left - 30, h = canvas.height - margin.top - margin.bottom;
  const x0 = margin.left, y0 = margin.top;
  const X = (k) => x0 + w * k / (n - 1), Y = (code) => y0 + h - h * zoom * code / most / 1.05;
  const isEmpty = (code) => code > (most + cavity) / 2;
  pen.save();
  pen.beginPath();
  for (let k = 0; k + 1 < n; ++k)
    if (isEmpty(frame.codes[k]) && isEmpty(frame.codes[k + 1])) pen.rect(X(k), y0, X(k + 1) - X(k) + 0.5, h);
  pen.clip();
  pen.strokeStyle = "#909090";
  pen.lineWidth = 1.5;
  for (let x = -h; x < w; x += 12) {
    pen.beginPath();
    pen.moveTo(x0 + x, y0 + h);
    pen.lineTo(x0 + x + h, y0);
    pen.stroke();
  }
  pen.restore();
  pen.strokeStyle = "#0060a0";
  pen.lineWidth = 2.5;
  pen.beginPath();
  for (let k = 0; k < n; ++k) pen.lineTo(X(k), Y(frame.codes[k] > most ? 0 : frame.codes[k]));
  pen.stroke();
  pen.fillStyle = "#d00000";
  for (const [x] of frame.parted) {
    pen.beginPath();
    pen.arc(x0 + w * (x - box[0]) / (box[1] - box[0]), y0 + h, 6, 0, 2 * Math.PI);
    pen.fill();
  }
  axes(x0, y0, w, h, box, [frame.coordinates[0], "p"]);
}

function told(frame) {
  if (frame.failure !== undefined) return frame.failure;
  let text = frame.fraction > 0 ? "The cavity fills " + shown(100 * frame.fraction) + " % of the domain." : "No cavity.";
  if (frame.parted_walls.length > 0) text += " The liquid parts from " + frame.parted_walls.join(", ") + " (red).";
  if (frame.coordinates.length === 3) text += " Section " + frame.coordinates[2] + " = " + shown(frame.height) + ".";
  text += " Largest pressure " + shown(frame.largest);
  return text + (frame.coordinates.length > 1 ? "; contours are " + shown(scaleTop(frame) / contours) + " apart." : ".");
}

let now = 0;
function show(k) {
  now = Math.max(0, Math.min(frames.length - 1, k));
  const frame = frames[now];
  pen.clearRect(0, 0, canvas.width, canvas.height);
  if (frame.failure === undefined) frame.points[1] > 1 ? drawPlane(frame) : drawLine(frame);
  scrubber.value = now;
  byId("value").textContent = liquid.parameter + " = " + shown(frame.value);
  byId("state").textContent = told(frame);
}
const first = frames[0].value, last = frames[frames.length - 1].value;
if (liquid.onset !== null) {
  const onset = liquid.onset.value, part = (onset - first) / (last - first);
  const error = liquid.onset.error, size = Math.abs(onset);
  const known = error > 0 && size > 0 ? Math.ceil(Math.log10(size / error)) + 1 : 15;
  const digits = Math.max(2, Math.min(15, known));
  const text = "Cavitation begins at " + liquid.parameter + " = " + onset.toPrecision(digits);
  const note = document.createElement("div");
  note.id = "onset";
  note.textContent = text + " (to " + liquid.onset.error.toPrecision(1) + ").";
  byId("state").after(note);
  if (part >= 0 && part <= 1) {
    const mark = document.createElement("button");
    mark.title = text;
    mark.style.left = 100 * part + "%";
    mark.onclick = () => {
      stop();
      let k = 0;
      while (k < frames.length - 1 && (frames[k].value - onset) * (last - first) < 0) ++k;
      show(k);
    };
    byId("marks").append(mark);
  }
}

let timer = null;
function stop() {
  if (timer !== null) clearTimeout(timer);
  timer = null;
  byId("play").textContent = "Play";
}
function tick() {
  if (now === frames.length - 1) return stop();
  show(now + 1);
  timer = setTimeout(tick, 1000 / Number(byId("speed").value));
}
byId("play").onclick = () => {
  if (timer !== null) return stop();
  if (now === frames.length - 1) show(0);
  byId("play").textContent = "Pause";
  timer = setTimeout(tick, 1000 / Number(byId("speed").value));
};
byId("own").onchange = () => show(now);
scrubber.oninput = () => { stop(); show(Number(scrubber.value)); };
// A page opened as F.html#2.5 shows the value nearest to it.
const asked = Number(location.hash.slice(1));
let begin = 0;
if (location.hash.length > 1 && !Number.isNaN(asked))
  frames.forEach((frame, k) => { if (Math.abs(frame.value - asked) < Math.abs(frames[begin].value - asked)) begin = k; });
show(begin);
document.body.dataset.ready = "yes";
)html";

}  // namespace

std::string liquid_page(const std::string& title, const std::string& data) {
  return page_with_data({"liquid", liquid_page_style, liquid_page_body, liquid_page_script}, title, data);
}

}  // namespace cli::inline drawings
