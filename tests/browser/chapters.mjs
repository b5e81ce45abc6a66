// Pages of studies in a real browser: node chapters.mjs CHROMIUM PAGE.html...
import assert from "node:assert/strict";
import { basename } from "node:path";
import { SIZES, accessible, everySize, fits, launched } from "./browser.mjs";

const [executablePath, ...files] = process.argv.slice(2);
const ALL_SIZES = [[320, 640], ...SIZES, [3840, 2160]];
// Parts are all alike: what is in those that are shut would be laid out element by element to be measured.
const FOLDED = ".part:not([open]) > :not(summary)";
const { browser, opened } = await launched(executablePath);

// The conclusion comes before everything else, and the contents lead to every chapter.
async function headed(page, what) {
  const conclusion = await page.locator("header > .headline").textContent();
  assert.match(conclusion, /\d/, `${what}: ${conclusion}`);
  const above = await page.locator("header > *").evaluateAll((all) => all.slice(0, 2).map((e) => e.className || e.tagName));
  assert.deepEqual(above, ["H1", "headline"], what);
  const links = await page.locator("nav a").evaluateAll((all) => all.map((a) => a.getAttribute("href")));
  const chapters = await page.locator("main > section[id]").evaluateAll((all) => all.map((e) => `#${e.id}`));
  assert.ok(links.length > 2, what);
  assert.deepEqual(links, chapters, what);
}

// Every figure is in sight, large enough to be read, with its numbers, which a click opens: of all in one size, of the first in
// the others, where a script opens the rest at once.
async function drawn(page, what, all) {
  const summaries = await page.locator("figure summary").all();
  for (const summary of all ? summaries : summaries.slice(0, 1)) await summary.click();
  const seen = await page.locator("figure").evaluateAll((figures, all) => figures.map((figure, i) => {
    const drawing = figure.querySelector("svg"), data = figure.querySelector("details"), table = figure.querySelector("table");
    if (!all && i) data.open = true;
    return { open: data.open, label: drawing.getAttribute("aria-label"), table: table.checkVisibility(),
      cells: figure.querySelectorAll("tbody td").length, width: drawing.checkVisibility() ? drawing.getBoundingClientRect().width : 0 };
  }), all);
  seen.forEach(({ open, width, label, table, cells }, i) => {
    const at = `${what}, figure ${i}`;
    assert.ok(width > 240, `${at}: ${width} px`);
    assert.ok(label && open && table, at);
    assert.ok(cells >= 3, at);
  });
}

// By keys alone: a chapter by its link, a folded part by its summary.
async function keys(page, what) {
  await page.locator("nav a").last().focus();
  await page.keyboard.press("Enter");
  assert.ok(await page.evaluate(() => document.querySelector(":target")?.tagName === "SECTION"), what);
  const folded = page.locator("details").first();
  if (!(await folded.count())) return;
  await folded.evaluate((part) => (part.open = false));
  await folded.locator("summary").focus();
  await page.keyboard.press("Enter");
  assert.ok(await folded.evaluate((part) => part.open), `${what}: a key opens it`);
}

// Of thousands of lines of drawings, which are one picture each for who cannot see them, of their tables, and of hundreds of folded
// parts, which are all alike, the first is enough.
async function lightened(page) {
  await page.evaluate(() => {
    document.querySelectorAll("svg").forEach((drawing, i) => i && drawing.replaceChildren());
    document.querySelectorAll(".part").forEach((part, i) => i && part.remove());
    document.querySelectorAll(".data").forEach((data, i) => (data.open = !i));
  });
  return page;
}

async function stands(file) {
  for (const size of ALL_SIZES) {
    const what = `${basename(file)}, ${size.join("x")}`;
    const { page, closed } = await opened(file, { size, scripted: false });
    if (size === SIZES[0] && (await page.locator("figure").count())) {
      await everySize(page, what, false);
      await page.setViewportSize({ width: size[0], height: size[1] });
    }
    await headed(page, what);
    await drawn(page, what, size === SIZES[1]);
    await page.locator(".part").evaluateAll((parts) => parts.slice(0, 1).forEach((part) => (part.open = true)));
    await fits(page, what, FOLDED);
    if (size === SIZES[0]) await accessible(await lightened(page), what);
    if (size === SIZES[1]) {
      await keys(page, what);
      await page.emulateMedia({ colorScheme: "dark" });
      await accessible(await lightened(page), `${what}, dark`, ["color-contrast"]);
    }
    await closed();
  }
  // Without script nothing is missing, and paper has no folded tables below figures.
  const { page, closed } = await opened(file, { size: SIZES[1], javaScriptEnabled: false });
  assert.equal(await page.locator("script").count(), 0);
  await page.emulateMedia({ media: "print" });
  for (const figure of await page.locator("figure").all()) {
    assert.ok(await figure.locator("svg").isVisible());
    assert.ok(!(await figure.locator(".data").isVisible()));
  }
  await fits(page, `${basename(file)} on paper`, FOLDED);
  await closed();
}

try {
  const began = performance.now();
  await Promise.all(files.map(stands));
  console.log(`${files.map((file) => basename(file)).join(", ")}: ${(performance.now() - began).toFixed(0)} ms`);
} finally {
  await browser.close();
}
