
// Lines and modes over time.
const font = '11px system-ui, -apple-system, "Segoe UI", Roboto, "Liberation Sans", sans-serif';
const LANE = 22;

// One scale for the panels of a row, but for those that have their own.
function fitted(group) {
  const whole = view.from <= first && view.to >= last;
  const range = (panels) => {
    if (whole) return panels[0].spec.y;
    let lo = Infinity, hi = -Infinity;
    const take = (x) => {
      if (x === null) return;
      if (x < lo) lo = x;
      if (x > hi) hi = x;
    };
    for (const { spec, track } of panels) {
      spec.always.forEach(take);
      const from = Math.max(placeOf(track, view.from), 0), to = placeOf(track, view.to) + 1;
      for (const line of spec.lines) {
        const values = track.columns[line.column];
        for (let i = from; i < to; i++) take(values[i]);
      }
    }
    if (!(hi >= lo)) return panels[0].spec.y;
    const room = Math.max(0.05 * (hi - lo), 0.005 * Math.max(Math.abs(lo), Math.abs(hi)), 1e-6);
    return [lo - room, hi + room];
  };
  const shared = group.filter((panel) => !panel.spec.own);
  if (shared.length) {
    const y = range(shared);
    for (const panel of shared) panel.y = y;
  }
  for (const panel of group) if (panel.spec.own) panel.y = range([panel]);
}

// Behind the lines: what goes on outside, and the modes of the supervisor or else contact.
function background(u, track, lanes) {
  const { ctx, bbox } = u;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  const fill = (from, to, style, top, height) => {
    if (to < view.from || from > view.to) return;
    const x = u.valToPos(Math.max(from, view.from), "x", true);
    const end = u.valToPos(Math.min(to, view.to), "x", true);
    ctx.fillStyle = style;
    ctx.fillRect(x, bbox.top + top * bbox.height, Math.max(end - x, 1), height * bbox.height);
  };
  for (const [from, to] of report.shaded) fill(from, to, colour("--shade"), 0, 1);
  if (lanes) {
    lanes.forEach((lane, i) => {
      for (const [mode, from, to] of track.bands[lane])
        fill(from, to, report.classes[lane][mode][1], (i + 0.05) / lanes.length, 0.9 / lanes.length);
    });
    for (const [t] of track.events) fill(t, t, colour("--ink"), 0, 0.12);
  } else {
    ctx.globalAlpha = 0.3;
    const kind = track.bands.supervisor.length ? "supervisor" : "rotor";
    for (const [mode, from, to] of track.bands[kind]) {
      // Calm is no band: the panel would be all colour.
      if (mode !== 0) fill(from, to, report.classes[kind][mode][1], 0, 1);
    }
  }
  ctx.restore();
}

function limitLine(u, at) {
  if (at === null) return;
  const { ctx, bbox } = u, y = u.valToPos(at, "y", true);
  if (y < bbox.top || y > bbox.top + bbox.height) return;
  ctx.save();
  ctx.strokeStyle = colour("--limit");
  ctx.lineWidth = 1.3 * devicePixelRatio;
  ctx.setLineDash([5 * devicePixelRatio, 5 * devicePixelRatio]);
  ctx.beginPath();
  ctx.moveTo(bbox.left, y);
  ctx.lineTo(bbox.left + bbox.width, y);
  ctx.stroke();
  ctx.restore();
}

function overTime(panel) {
  const { spec, track, room } = panel;
  const lanes = spec.kind === "modes" ? spec.lanes : null;
  const lines = lanes ? [] : spec.lines;
  panel.y = lanes ? [0, lanes.length] : spec.y;
  panel.height = lanes ? LANE * lanes.length + 34 : 168;
  const data = lanes
    ? [report.window, [null, null]]
    : [track.t, ...lines.map((line) => track.columns[line.column])];
  const axis = { stroke: () => colour("--ink"), grid: { stroke: () => colour("--grid"), width: 1 }, font,
    ticks: { stroke: () => colour("--grid"), size: 4 } };
  const series = lines.map((line) => ({
    stroke: () => onPaper(line.colour), width: 1.3, points: { show: false }, scale: "y",
  }));
  panel.chart = new uPlot({
    width: Math.max(room.clientWidth, 120), height: panel.height, pxAlign: 0,
    legend: { show: false },
    scales: {
      x: { time: false, range: () => [view.from, view.to] },
      y: { auto: false, range: () => panel.y },
    },
    axes: [
      { ...axis, size: 26, values: (u, ticks) => ticks.map((t) => short(t) + " " + track.unit), space: 64 },
      lanes
        ? { ...axis, grid: { show: false }, ticks: { show: false }, size: 70, gap: 2,
            splits: () => lanes.map((_, i) => lanes.length - i - 0.5), values: () => lanes }
        : { ...axis, size: 54, label: spec.name, labelSize: 16, labelFont: font, labelGap: 0, gap: 2,
            values: (u, ticks) => ticks.map(short), space: 28 },
    ],
    series: [{}, ...(lanes ? [{ show: true, points: { show: false }, scale: "y" }] : series)],
    cursor: {
      y: false, drag: { x: true, y: false, setScale: false, dist: 5 }, points: { size: 6 },
      bind: {
        dblclick: () => () => back(),
        mouseleave: (u, over, leave) => (e) => {
          leave(e);
          place(panel);
        },
      },
    },
    hooks: {
      drawClear: [(u) => background(u, track, lanes)],
      draw: [(u) => lanes || limitLine(u, spec.limit)],
      setCursor: [(u) => u.cursor.left >= 0 && !moving && goTo(u.posToVal(u.cursor.left, "x"))],
      setSelect: [(u) => {
        const { left, width } = u.select;
        u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
        if (width > 4) look(u.posToVal(left, "x"), u.posToVal(left + width, "x"));
      }],
    },
  }, data, room);
}

// The instant in a panel over time: line and values.
function place(panel) {
  const { chart, spec, track } = panel;
  const share = (instant - view.from) / (view.to - view.from);
  // Not the width of an element: to ask for that lays out the page anew, panel by panel.
  const left = inView(instant) ? (share * chart.bbox.width) / devicePixelRatio : -10;
  chart.setCursor({ left, top: 0 }, false);
  const at = placeOf(track, instant);
  // A slow track goes on when the ticks are over, and begins later.
  if (instant < track.t[0] - hair || instant > track.t.at(-1) + hair) {
    panel.value.textContent = "–";
    return;
  }
  const said = spec.kind === "modes"
    ? spec.lanes.map((lane) => {
        const band = bandAt(track.bands[lane], instant);
        return band ? report.classes[lane][band[0]][0] : "–";
      })
    : spec.lines.map((line) => short(track.columns[line.column][at]));
  panel.value.textContent = said.join(" | ");
}
