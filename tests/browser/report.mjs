// Pages of the host in a real browser: node report.mjs CHROMIUM RUN.html MACHINE.html RECORD.html SWEEP.html MODES.html
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { SIZES, accessible, everySize, fits, launched } from "./browser.mjs";

// On an idle machine it takes less than one; here others may be at work.
const OPENS_WITHIN_MS = 6000;

const [executablePath, run, machine, record, sweep, modes] = process.argv.slice(2);
// A page that stands still is wanted from the smallest screen to the largest.
const STILL_SIZES = [[320, 640], [1280, 800], [3840, 2160]];
const { browser, opened } = await launched(executablePath);

// Reads what the figures show from the outside: pixels, lines, texts.
const shownBy = (page) => page.evaluate(() => {
  const panels = [...document.querySelectorAll("[data-panel]")];
  // Read from a copy: reading a canvas of the page would change how it is drawn.
  const copy = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  const pixels = (canvas) => {
    if (!canvas) return null;
    [copy.canvas.width, copy.canvas.height] = [canvas.width, canvas.height];
    copy.drawImage(canvas, 0, 0);
    return new Uint32Array(copy.getImageData(0, 0, canvas.width, canvas.height).data.buffer);
  };
  const sum = (canvas) => pixels(canvas)?.reduce((sum, pixel) => (Math.imul(sum, 31) + pixel) | 0, 0) ?? null;
  return {
    colours: panels.map((panel) => new Set(pixels(panel.querySelector("canvas"))).size),
    drawn: panels.map((panel) => sum(panel.querySelector("canvas"))),
    overTime: panels.map((panel) => panel.querySelector(".u-over") !== null),
    lines: panels.map((panel) => {
      const line = panel.querySelector(".u-cursor-x"), over = panel.querySelector(".u-over");
      if (!line) return null;
      const at = line.getBoundingClientRect(), room = over.getBoundingClientRect();
      return (at.right - room.left) / room.width;
    }),
    orbits: panels.map((panel) => sum(panel.querySelector("canvas.over"))),
    values: panels.map((panel) => panel.querySelector(".value").textContent),
    said: document.querySelector("#controls output").textContent,
  };
});

const same = (values) => Math.max(...values) - Math.min(...values) < 0.01;
const view = (page) => page.locator('[data-do="time"]').evaluate((time) => [+time.min, +time.max]);
const shows = async (page, stretch, what) => {
  const shown = await view(page);
  shown.forEach((t, i) => assert.ok(Math.abs(t - stretch[i]) < 1e-6, `${what ?? ""}: ${shown} in the place of ${stretch}`));
};
const dataOf = (page) => page.evaluate(() => JSON.parse(document.getElementById("report-data").textContent));
const instant = async (page) => parseFloat(await page.textContent("#controls output"));

async function allDrawn(page, what) {
  const { colours, overTime } = await shownBy(page);
  assert.ok(colours.length >= 5, `${what}: ${colours.length} panels`);
  assert.ok(overTime.some((is) => is) && overTime.some((is) => !is), what);
  colours.forEach((count, i) => assert.ok(count > 5, `${what}: panel ${i} has ${count} colours`));
  // What does not move stays in sight beside what does, with its numbers.
  const still = await page.locator("section:not(.still) figure:not([data-panel])").all();
  if (what.startsWith("machine")) assert.ok(still.length >= 2, `${what}: ${still.length} drawings of the axis`);
  for (const figure of still) {
    assert.ok(await figure.locator("svg").isVisible(), what);
    assert.ok((await figure.locator("td").count()) >= 3, what);
  }
}

// The event has the width, and the whole is one step away.
async function opensOnTheEvent(page, what) {
  const { window, focus, tracks } = await dataOf(page);
  const opened = await view(page);
  await shows(page, focus, what);
  const times = tracks.find((track) => track.events.length).events.map(([t]) => t).filter((t) => t >= focus[0] && t <= focus[1]);
  const share = (times.at(-1) - times[0]) / (focus[1] - focus[0]);
  assert.ok(share > 0.4, `${what}: the event has ${share} of the width`);
  await page.click('[data-do="whole"]');
  await shows(page, window, what);
  await page.click('[data-do="back"]');
  await shows(page, opened, what);
}

async function moves(page) {
  const opened = await view(page);
  const before = await shownBy(page);
  const times = before.overTime.flatMap((is, i) => (is ? [i] : []));
  const first = page.locator("[data-panel] .u-over").first();
  await first.scrollIntoViewIfNeeded();
  const room = await first.boundingBox();

  // The mouse moves one time for all.
  await page.mouse.move(room.x + 0.3 * room.width, room.y + 20);
  const pointed = await shownBy(page);
  assert.ok(same(times.map((i) => pointed.lines[i])), `lines at ${pointed.lines}`);
  assert.ok(Math.abs(pointed.lines[times[0]] - 0.3) < 0.02, `${pointed.lines[times[0]]}`);
  assert.notDeepEqual(pointed.orbits, before.orbits, "the dots of the orbits move too");
  assert.notDeepEqual(pointed.values, before.values);

  // Dragging zooms all; double click goes back.
  await page.mouse.move(room.x + 0.2 * room.width, room.y + 20);
  await page.mouse.down();
  await page.mouse.move(room.x + 0.4 * room.width, room.y + 30, { steps: 5 });
  await page.mouse.up();
  const zoomed = await shownBy(page);
  for (const i of times) assert.notEqual(zoomed.drawn[i], before.drawn[i], `panel ${i} is zoomed`);
  const [from, to] = await view(page), size = opened[1] - opened[0];
  assert.ok(Math.abs((to - from) / size - 0.2) < 0.01, `${from} to ${to} of ${opened}`);
  await page.mouse.dblclick(room.x + 0.5 * room.width, room.y + 20);
  await shows(page, opened);

  // An entry of the event list leads to its time, also when that is not in view.
  const entry = page.locator("[data-t] button").last();
  const at = parseFloat(await entry.textContent());
  await entry.click();
  assert.ok(Math.abs((await instant(page)) - at) < 2e-3, `${await instant(page)} for ${at}`);
  await page.keyboard.press("p");
  assert.ok((await instant(page)) < at, "P goes to the event before");
  await page.keyboard.press("n");
  assert.ok(Math.abs((await instant(page)) - at) < 2e-3, "N goes to the next");

  // Keys alone: zoom, step, escape, play.
  await page.evaluate(() => document.activeElement.blur());
  const close = await view(page);
  await page.keyboard.press("+");
  const [left, right] = await view(page);
  assert.ok(Math.abs((right - left) / size - 0.5) < 0.01, `+ shows ${left} to ${right}`);
  const here = await instant(page);
  await page.keyboard.press("ArrowLeft");
  assert.ok((await instant(page)) < here);
  await page.keyboard.press("Escape");
  await shows(page, close);
  await page.keyboard.press("0");
  await shows(page, (await dataOf(page)).window);
  await page.evaluate(() => document.activeElement.blur());
  const still = await instant(page);
  await page.keyboard.press("Space");
  await page.waitForTimeout(400);
  const playing = await instant(page);
  assert.notEqual(playing, still, "space plays");
  await page.keyboard.press("Space");
  const stopped = await instant(page);
  await page.waitForTimeout(150);
  assert.equal(await instant(page), stopped, "and stops");
  await page.click('[data-do="play"]');
  await page.waitForTimeout(200);
  assert.notEqual(await instant(page), stopped, "the button plays as well");
  await page.click('[data-do="play"]');

  // Every control can be reached by the tab key.
  await page.focus('[data-do="play"]');
  const reached = new Set();
  for (let i = 0; i < 12; i++) {
    reached.add(await page.evaluate(() => document.activeElement.dataset.do));
    await page.keyboard.press("Tab");
  }
  for (const name of ["play", "speed", "next", "previous", "in", "out", "whole", "back", "time"])
    assert.ok(reached.has(name), `${name} among ${[...reached]}`);
}

// What goes on after the ticks that were recorded one by one: in view, with the time of all, and zoomed with all.
async function slowTrack(page) {
  const panels = await page.evaluate(() => [...document.querySelectorAll("[data-panel]")]
    .map((panel) => panel.querySelector("figcaption b").textContent));
  const slow = panels.flatMap((name, i) => (name.endsWith("slow track") ? [i] : []));
  assert.ok(slow.length >= 5, `${slow.length} panels of the slow track among ${panels}`);
  const { tracks } = await dataOf(page);
  const end = ({ t: { step, differences } }) => step * differences.reduce((sum, d) => sum + d, 0);
  const of = (wanted) => end(tracks.find((track) => track.name.endsWith("slow track") === wanted));
  const late = 0.5 * (of(true) + of(false));
  assert.ok(of(true) > 2 * of(false), `${of(true)} ms after ${of(false)} ms`);
  // There the ticks have no value any more, and the slow track has.
  await page.click('[data-do="whole"]');
  await page.evaluate((t) => {
    const time = document.querySelector('[data-do="time"]');
    time.value = t;
    time.dispatchEvent(new Event("input"));
  }, late);
  const shown = await shownBy(page);
  const fast = panels.indexOf("recorded", 1);
  assert.equal(shown.values[fast], "–", "the ticks are over");
  for (const i of slow) assert.notEqual(shown.values[i], "–", `panel ${i} at ${late} ms`);
  assert.ok(same(slow.map((i) => shown.lines[i]).concat(shown.lines[fast])), `lines at ${shown.lines}`);
  await page.click('[data-do="focus"]');
  const close = await shownBy(page);
  for (const i of slow) assert.notEqual(close.drawn[i], shown.drawn[i], `panel ${i} is zoomed`);
  await page.click('[data-do="whole"]');
}

// One page at every size in both lights; of the others, which have the same parts, every size is drawn, and one is worked with.
async function works(name, file) {
  for (const size of SIZES) {
    const whole = name === "run" || size === SIZES[1];
    for (const colorScheme of whole ? ["light", "dark"] : ["light"]) {
      const what = `${name}, ${size.join("x")}, ${colorScheme}`;
      const { page, closed } = await opened(file, { size, colorScheme });
      await allDrawn(page, what);
      await fits(page, what);
      if (colorScheme === "light" && whole) {
        await opensOnTheEvent(page, what);
        await moves(page);
        if (name === "record") await slowTrack(page);
        await accessible(page, what);
      } else if (whole) await accessible(page, what, ["color-contrast"]);
      await closed();
    }
  }
  const resized = await opened(file, { size: SIZES[1] });
  await everySize(resized.page, name);
  await resized.closed();
  // Without script the figures stand still, on paper too.
  const { page, closed } = await opened(file, { size: SIZES[0], javaScriptEnabled: false });
  const figures = page.locator("figure svg");
  assert.ok((await figures.count()) >= 5);
  assert.ok(await figures.first().isVisible());
  assert.ok(!(await page.locator("#controls").isVisible()));
  await fits(page, `${name} without script`);
  await closed();
  const printed = await opened(file, { size: SIZES[1] });
  await printed.page.emulateMedia({ media: "print" });
  assert.ok(await printed.page.locator("figure svg").first().isVisible());
  assert.ok(!(await printed.page.locator(".live").first().isVisible()));
  if (name === "record") await accessible(printed.page, "drawings of the record");
  await printed.closed();
}

// A page without a script: drawn, with the numbers of each drawing, and links to files that are there.
async function stands(name, file, drawings, links) {
  const resized = await opened(file, { size: SIZES[1], scripted: false });
  await everySize(resized.page, name);
  await resized.closed();
  for (const size of STILL_SIZES) {
    for (const colorScheme of ["light", "dark"]) {
      const what = `${name}, ${size.join("x")}, ${colorScheme}`;
      const { page, closed } = await opened(file, { size, colorScheme, scripted: false });
      const figures = page.locator("figure");
      assert.ok((await figures.count()) >= drawings, what);
      for (const figure of await figures.all()) {
        assert.ok(await figure.locator("svg").isVisible(), what);
        const wide = await figure.locator("svg").evaluate((drawing) => drawing.getBoundingClientRect().width);
        assert.ok(wide > 240, `${what}: ${wide} px`);
        await figure.locator("summary").click();
        assert.ok((await figure.locator("td").count()) >= 3, what);
        assert.ok(await figure.locator("table").isVisible(), what);
      }
      await fits(page, what);
      await accessible(page, what, colorScheme === "dark" ? ["color-contrast"] : undefined);
      for (const link of await page.locator("a").all()) {
        const target = new URL(await link.getAttribute("href"), pathToFileURL(file));
        assert.ok(readFileSync(target, "utf8").includes("[start]"), `${what}: ${target}`);
      }
      assert.equal(await page.locator("a").count(), links, what);
      await closed();
    }
  }
  const printed = await opened(file, { size: SIZES[1], scripted: false });
  await printed.page.emulateMedia({ media: "print" });
  assert.ok(await printed.page.locator("figure svg").first().isVisible());
  assert.ok(!(await printed.page.locator(".data").first().isVisible()));
  await fits(printed.page, `${name} on paper`);
  await printed.closed();
}

try {
  // Alone, and once before to start the browser's processes.
  for (const which of ["first", "second"]) {
    const { took, closed } = await opened(run, { size: SIZES[1] });
    await closed();
    console.log(`${which} opening of the run: ${took.toFixed(0)} ms`);
    assert.ok(took < OPENS_WITHIN_MS, `opened in ${took} ms`);
  }
  const began = performance.now();
  await Promise.all([...Object.entries({ run, machine, record }).map(([name, file]) => works(name, file)),
    stands("sweep", sweep, 6, 3), stands("modes", modes, 3, 0)]);
  console.log(`everything else: ${(performance.now() - began).toFixed(0)} ms`);
} finally {
  await browser.close();
}
