
// Panels that move together, and what moves them.
const panels = [];
const groups = new Map();
let moving = false;
let playing = null;
const controls = document.getElementById("controls");
const control = (what) => controls.querySelector(`[data-do="${what}"]`);

function goTo(t) {
  instant = Math.min(Math.max(t, first), last);
  moving = true;
  for (const panel of panels) panel.spec.kind === "orbit" ? placeOrbit(panel) : place(panel);
  moving = false;
  told();
}

// Time, and the event that was last.
function told() {
  const unit = report.tracks[0].unit;
  const event = events.findLast((e) => e.t <= instant);
  control("time").min = view.from;
  control("time").max = view.to;
  control("time").value = instant;
  const text = `${instant.toFixed(unit === "ms" ? 3 : 0)} ${unit}`;
  control("time").setAttribute("aria-valuetext", text);
  controls.querySelector("output").textContent =
    text + (event ? `; last event at ${short(event.t)} ${unit}: ${event.text}` : "");
}

function drawAll() {
  for (const group of groups.values()) if (group[0].spec.kind === "lines") fitted(group);
  moving = true;
  for (const panel of panels) {
    if (panel.spec.kind === "orbit") drawOrbit(panel);
    else panel.chart.batch(() => {
      panel.chart.setScale("x", { min: view.from, max: view.to });
      panel.chart.setScale("y", { min: panel.y[0], max: panel.y[1] });
    });
  }
  moving = false;
  goTo(instant);
}

// Shows another stretch of time; the one before is kept for going back.
function look(from, to, remember = true) {
  const least = 1e-6 * (last - first), size = Math.min(Math.max(to - from, least), last - first);
  from = Math.min(Math.max(from, first), last - size);
  if (from === view.from && from + size === view.to) return;
  if (remember) view.past.push([view.from, view.to]);
  [view.from, view.to] = [from, from + size];
  if (!inView(instant)) instant = view.from;
  drawAll();
}

function back() {
  const [from, to] = view.past.pop() ?? [first, last];
  look(from, to, false);
}

function zoom(times) {
  const size = (view.to - view.from) * times;
  const share = inView(instant) ? (instant - view.from) / (view.to - view.from) : 0.5;
  const middle = view.from + share * (view.to - view.from);
  look(middle - share * size, middle + (1 - share) * size);
}

// Goes to an instant, wherever it is.
function show(t) {
  if (!inView(t)) {
    const size = view.to - view.from;
    instant = t;
    look(t - size / 2, t + size / 2);
  }
  goTo(t);
}

// Rounding of written times must not hold an event.
const hair = 1e-9 * (last - first);
const next = () => show((events.find((e) => e.t > instant + hair) ?? events.at(-1)).t);
const previous = () => show((events.findLast((e) => e.t < instant - hair) ?? events[0]).t);

function play() {
  const button = control("play");
  if (playing !== null) {
    cancelAnimationFrame(playing);
    playing = null;
    button.textContent = "Play";
    return;
  }
  if (instant >= view.to - hair || !inView(instant)) goTo(view.from);
  button.textContent = "Stop";
  let before = performance.now();
  const frame = (now) => {
    const speed = (view.to - view.from) / (1e3 * control("speed").value);
    const t = instant + Math.max(now - before, 0) * speed;
    before = now;
    goTo(Math.min(t, view.to));
    if (t >= view.to) play();
    else playing = requestAnimationFrame(frame);
  };
  playing = requestAnimationFrame(frame);
}

const actions = {
  play, next, previous, back,
  in: () => zoom(0.5),
  out: () => zoom(2),
  whole: () => look(first, last),
  focus: () => report.focus && look(...report.focus),
};

function step(share) {
  show(instant + share * (view.to - view.from));
}

const keys = {
  " ": play, n: next, p: previous, "+": actions.in, "=": actions.in, "-": actions.out, 0: actions.whole, c: actions.focus,
  Escape: back, ArrowLeft: (e) => step(e.shiftKey ? -0.05 : -0.005), ArrowRight: (e) => step(e.shiftKey ? 0.05 : 0.005),
};

function onKey(e) {
  const arrow = e.key.startsWith("Arrow");
  if (e.ctrlKey || e.altKey || e.metaKey || e.target.closest("select") || (arrow && e.target.closest("input"))) return;
  // A control that has the focus does with the space key what it does anyway.
  if (e.key === " " && e.target.closest("button, summary, a")) return;
  // A table that scrolls is moved by its keys.
  if (arrow && e.target.closest(".scroll")) return;
  const action = keys[e.key.length === 1 ? e.key.toLowerCase() : e.key];
  if (!action || ((action === next || action === previous) && !events.length)) return;
  e.preventDefault();
  action(e);
}

function build() {
  for (const figure of document.querySelectorAll("[data-panel]")) {
    const spec = report.panels[figure.dataset.panel];
    const panel = { spec, track: report.tracks[spec.track], room: document.createElement("div") };
    panel.room.className = "live";
    panel.room.setAttribute("role", "img");
    panel.room.setAttribute("aria-label", figure.querySelector("svg").getAttribute("aria-label"));
    panel.value = document.createElement("span");
    panel.value.className = "value";
    figure.querySelector("figcaption").append(" ", panel.value);
    figure.querySelector(".still").before(panel.room);
    panels.push(panel);
    groups.set(spec.group, [...(groups.get(spec.group) ?? []), panel]);
  }
  document.documentElement.classList.add("scripted");
  controls.hidden = false;
  for (const panel of panels) panel.spec.kind === "orbit" ? orbit(panel) : overTime(panel);
  const sizes = new ResizeObserver((all) => {
    for (const { target } of all) {
      const panel = panels.find((p) => p.room === target);
      if (panel.chart) panel.chart.setSize({ width: Math.max(target.clientWidth, 120), height: panel.height });
      else drawOrbit(panel);
    }
    goTo(instant);
  });
  drawAll();
  for (const panel of panels) sizes.observe(panel.room);
  for (const name in actions) control(name).addEventListener("click", actions[name]);
  control("time").addEventListener("input", (e) => goTo(+e.target.value));
  control("focus").hidden = !report.focus;
  for (const name of ["next", "previous"]) control(name).hidden = !events.length;
  const thinned = report.tracks.filter((track) => track.t.length < track.of);
  control("rows").textContent = thinned.length
    ? `Of a long run the lowest and highest of neighbouring rows are in this page, more of them where the events are; zoomed in, the
       lines join these. ${thinned.map((t) => `${t.name}: ${t.t.length} of ${t.of} rows`).join(", ")}.`
    : "Every row of the runs is in this page.";
  for (const cell of document.querySelectorAll("[data-t]")) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = cell.textContent;
    button.addEventListener("click", () => show(+cell.dataset.t));
    cell.replaceChildren(button);
  }
  document.addEventListener("keydown", onKey);
  dark.addEventListener("change", () => {
    for (const panel of panels) panel.chart?.redraw(false, true);
    drawAll();
  });
}

if (controls) build();
