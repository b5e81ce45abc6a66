
// The rotor's path in the plane, with its direction and time.
const ARROWS = 8;

function orbit(panel) {
  panel.base = document.createElement("canvas");
  panel.over = document.createElement("canvas");
  panel.over.className = "over";
  panel.room.classList.add("orbit");
  panel.room.append(panel.base, panel.over);
}

// Pixels of a place.
function scaled(panel) {
  const { reach, size } = panel, edge = 30;
  const k = (size - edge - 6) / (2 * reach || 1);
  return (x, y) => [edge + (x + reach) * k, 3 + (reach - y) * k];
}

function prepared(canvas, size) {
  const pixels = Math.round(size * devicePixelRatio);
  if (canvas.width !== pixels) {
    canvas.width = canvas.height = pixels;
    canvas.style.width = canvas.style.height = size + "px";
  }
  const ctx = canvas.getContext("2d");
  ctx.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
  ctx.clearRect(0, 0, size, size);
  ctx.font = font;
  return ctx;
}

function arrow(ctx, [x, y], [dx, dy], size, style) {
  const length = Math.hypot(dx, dy);
  if (!(length > 0)) return;
  const [c, s] = [dx / length, dy / length];
  ctx.fillStyle = style;
  ctx.beginPath();
  ctx.moveTo(x + size * c, y + size * s);
  ctx.lineTo(x - size * (c - 0.7 * s), y - size * (s + 0.7 * c));
  ctx.lineTo(x - size * (c + 0.7 * s), y - size * (s - 0.7 * c));
  ctx.fill();
}

// Where it moves to in pixels, over a step that can be seen.
function direction(track, to, at) {
  const { x, y } = track.columns, here = to(x[at], y[at]);
  for (let i = at + 1; i < track.t.length; i++) {
    const there = to(x[i], y[i]), d = [there[0] - here[0], there[1] - here[1]];
    if (Math.hypot(...d) > 1) return d;
  }
  return [0, 0];
}

function grid(ctx, panel, to) {
  const { unit, wall } = panel.spec, { reach, size } = panel;
  const power = 10 ** Math.floor(Math.log10(reach || 1));
  const step = [0.5, 1, 2, 5].map((f) => f * power).find((s) => reach / s <= 3.5) ?? power;
  ctx.strokeStyle = colour("--grid");
  ctx.fillStyle = colour("--ink");
  ctx.lineWidth = 1;
  for (let i = -3; i <= 3; i++) {
    const at = i * step;
    if (Math.abs(at) > reach) continue;
    const [x, y] = to(at, at);
    ctx.beginPath();
    ctx.moveTo(x, 3);
    ctx.lineTo(x, size - 27);
    ctx.moveTo(30, y);
    ctx.lineTo(size - 3, y);
    ctx.stroke();
    ctx.textAlign = "center";
    ctx.fillText(short(at), x, size - 14);
    // The name of the axis is there.
    if (y < 20) continue;
    ctx.textAlign = "right";
    ctx.fillText(short(at), 28, y + 4);
  }
  ctx.textAlign = "right";
  ctx.fillText("x / " + unit, size - 3, size - 2);
  ctx.textAlign = "left";
  ctx.fillText("y / " + unit, 2, 12);
  const [a, b, tilt] = wall, [cx, cy] = to(0, 0), k = to(1, 0)[0] - cx;
  ctx.strokeStyle = colour("--limit");
  ctx.lineWidth = 1.3;
  ctx.beginPath();
  ctx.ellipse(cx, cy, a * k, b * k, -tilt, 0, 2 * Math.PI);
  ctx.stroke();
}

// A path with a scale of its own fills it with what is in view.
function reachInView({ spec, track }, from, end) {
  if (!spec.own) return spec.reach;
  const { x, y } = track.columns;
  let most = spec.wall[0];
  for (let i = from; i <= end; i++) most = Math.max(most, Math.abs(x[i]), Math.abs(y[i]));
  return 1.05 * most;
}

// The path in view; contact on top, arrows at equal times.
function drawOrbit(panel) {
  const { track } = panel, { x, y } = track.columns;
  const from = placeOf(track, view.from), end = placeOf(track, view.to);
  panel.reach = reachInView(panel, from, end);
  panel.size = Math.max(120, Math.min(panel.room.clientWidth, 460));
  const ctx = prepared(panel.base, panel.size), to = scaled(panel);
  grid(ctx, panel, to);
  // Where rows were left out the rotor has turned meanwhile: dots, no lines.
  const apart = track.t.length < track.of ? 2.5 * track.period : Infinity;
  for (const touching of ["0", "1"]) {
    ctx.strokeStyle = ctx.fillStyle = colour(touching === "1" ? "--touching" : "--free");
    ctx.lineWidth = touching === "1" ? 1.6 : 1;
    ctx.beginPath();
    for (let i = from; i < end; i++) {
      if (track.touching[i] !== touching || x[i] === null || x[i + 1] === null) continue;
      const here = to(x[i], y[i]);
      if (track.t[i + 1] - track.t[i] > apart) {
        ctx.fillRect(here[0] - 0.7, here[1] - 0.7, 1.4, 1.4);
        continue;
      }
      ctx.moveTo(...here);
      ctx.lineTo(...to(x[i + 1], y[i + 1]));
    }
    ctx.stroke();
  }
  const named = [];
  ctx.textAlign = "left";
  for (let i = 0; i < ARROWS; i++) {
    const at = placeOf(track, view.from + ((i + 0.5) / ARROWS) * (view.to - view.from));
    if (at < from || at >= end || x[at] === null) continue;
    const here = to(x[at], y[at]);
    arrow(ctx, here, direction(track, to, at), 5, colour("--ink"));
    // Times that would lie on each other are left out.
    if (named.some(([x, y]) => Math.abs(x - here[0]) < 66 && Math.abs(y - here[1]) < 16)) continue;
    named.push(here);
    ctx.fillText(`${short(track.t[at])} ${track.unit}`, Math.min(here[0] + 8, panel.size - 60), here[1] - 6);
  }
}

// The rotor at the instant, with an arrow and the way that it came.
function placeOrbit(panel) {
  const { track } = panel, { x, y } = track.columns;
  const ctx = prepared(panel.over, panel.size), to = scaled(panel), at = placeOf(track, instant);
  if (x[at] === undefined || x[at] === null) return;
  const here = to(x[at], y[at]), ink = colour("--cursor");
  const back = placeOf(track, instant - (view.to - view.from) / 40);
  ctx.strokeStyle = ink;
  ctx.lineWidth = 2;
  ctx.globalAlpha = 0.6;
  ctx.beginPath();
  for (let i = back; i <= at; i++) if (x[i] !== null) ctx.lineTo(...to(x[i], y[i]));
  ctx.stroke();
  ctx.globalAlpha = 1;
  const way = direction(track, to, at), length = Math.hypot(...way) || 1;
  arrow(ctx, [here[0] + (9 * way[0]) / length, here[1] + (9 * way[1]) / length], way, 5, ink);
  ctx.fillStyle = ink;
  ctx.beginPath();
  ctx.arc(...here, 4, 0, 2 * Math.PI);
  ctx.fill();
  // Always as long, or the panel would jump.
  const decimals = Math.min(Math.max(3 - Math.ceil(Math.log10(panel.reach || 1)), 0), 9);
  panel.value.textContent = [x, y].map((of) => of[at].toFixed(decimals).replace("-", "\u2212")).join(", ");
}
