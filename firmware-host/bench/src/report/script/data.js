
"use strict";
// What the page brings with it, and what all figures share: the stretch of time in view and one instant.
const report = JSON.parse(document.getElementById("report-data").textContent);

const decoded = ({ step, differences }) => {
  let at = 0;
  return differences.map((d) => (d === null ? null : (at += d) * step));
};

for (const track of report.tracks) {
  track.t = decoded(track.t);
  for (const name in track.columns) track.columns[name] = decoded(track.columns[name]);
}

const [first, last] = report.window;
// Opens on the event; back leads to the whole.
const [from, to] = report.focus ?? report.window;
const view = { from, to, past: [] };
let instant = from;

// Events of all tracks, each instant once.
const events = [];
for (const [t, text] of report.tracks.flatMap((track) => track.events).sort((a, b) => a[0] - b[0])) {
  const before = events.at(-1);
  if (before && before.t === t) {
    if (!before.text.includes(text)) before.text += "; " + text;
  } else events.push({ t, text });
}

// Place of the last row that is not later.
function placeOf(track, t) {
  let lo = 0, hi = track.t.length;
  while (lo < hi) {
    const mid = (lo + hi) >> 1;
    if (track.t[mid] <= t) lo = mid + 1;
    else hi = mid;
  }
  return Math.max(lo - 1, 0);
}

const bandAt = (bands, t) => bands.find(([, from, to]) => from <= t && t < to) ?? bands.at(-1);
const inView = (t) => t >= view.from && t <= view.to;

// Colours of the style sheet; those of lines are lighter on dark paper.
const dark = matchMedia("(prefers-color-scheme: dark)");
const palette = new Map();
dark.addEventListener("change", () => palette.clear());
function colour(name) {
  if (!palette.has(name))
    palette.set(name, getComputedStyle(document.documentElement).getPropertyValue(name).trim());
  return palette.get(name);
}
function onPaper(hex) {
  if (!dark.matches) return hex;
  const parts = [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
  return `rgb(${parts.map((part) => Math.round(part + 0.45 * (255 - part))).join(" ")})`;
}

const plain = new Intl.NumberFormat("en", { maximumSignificantDigits: 4, useGrouping: false });
function short(x) {
  if (x === null || x === undefined) return "–";
  const size = Math.abs(x);
  const text = size !== 0 && (size < 1e-3 || size >= 1e6) ? x.toExponential(1).replace("e+", "e") : plain.format(x);
  return text.replaceAll("-", "\u2212");
}
