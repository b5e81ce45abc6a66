// What the checks of all pages share: a browser, a page in it, and what holds of every page.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const AXE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
export const SIZES = [[390, 844], [1280, 800], [2560, 1440]];
const ALL_SIZES = [[320, 640], [390, 844], [768, 1024], [1280, 800], [1920, 1080], [2560, 1440], [3840, 2160]];

// A browser, and what opens a file in it and watches what it says and asks for.
export async function launched(executablePath) {
  const browser = await chromium.launch({ executablePath, args: ["--no-sandbox"] });
  const opened = async (file, { size, colorScheme = "light", javaScriptEnabled = true, scripted = javaScriptEnabled }) => {
    const [width, height] = size;
    const context = await browser.newContext({ viewport: { width, height }, colorScheme, javaScriptEnabled });
    const page = await context.newPage();
    const said = [], requests = [];
    page.on("console", (message) => said.push(message.text()));
    page.on("pageerror", (error) => said.push(error.message));
    page.on("request", (request) => requests.push(request.url()));
    const began = performance.now();
    await page.goto(pathToFileURL(file).href);
    if (scripted) {
      await page.waitForSelector("html.scripted", { state: "attached" });
      // Until everything is on the screen.
      await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => setTimeout(done))));
    }
    const took = performance.now() - began;
    const closed = async () => {
      assert.deepEqual(said, [], `${file}: the console is empty`);
      assert.deepEqual(requests, [pathToFileURL(file).href], "nothing but the file is asked for");
      await context.close();
    };
    return { page, took, closed };
  };
  return { browser, opened };
}

export async function fits(page, what, apart = ".live") {
  const [wide, room] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
  assert.ok(wide <= room, `${what}: ${wide} px in ${room} px`);
  // What is wider than its room must be in a part that scrolls.
  const cut = await page.evaluate((apart) => [...document.querySelectorAll("body *")]
    .filter((e) => !e.closest(`.scroll, svg, .live, ${apart}`) && e.getClientRects().length && e.getBoundingClientRect().right > innerWidth + 1)
    .map((e) => e.outerHTML.slice(0, 80)), apart);
  assert.deepEqual(cut, [], `${what}: nothing is cut`);
}

// Nothing is beyond the edge, a figure is in the first screen, and figures use the width of a wide one.
export async function everySize(page, what, wide = true) {
  for (const [width, height] of ALL_SIZES) {
    await page.setViewportSize({ width, height });
    // What follows the size has been drawn anew.
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done)))));
    const at = `${what}, ${width}x${height}`;
    await fits(page, at);
    const drawings = await page.locator("figure .live, figure svg").evaluateAll((all) => all
      .map((e) => e.getBoundingClientRect()).filter((r) => r.height > 0).map(({ top, bottom, right }) => ({ top, bottom, right })));
    const { top, bottom } = drawings[0];
    if (width > 320) assert.ok(top > 0 && bottom > top + 100 && bottom <= height, `${at}: the first figure is from ${top} to ${bottom}`);
    const right = Math.max(...drawings.map((drawing) => drawing.right));
    if (wide && width > 1280) assert.ok(right > 0.7 * width, `${at}: figures end at ${right}`);
  }
}

// In the dark only the colours are others. What is not to be seen is not looked at: thousands of lines of drawings would only
// be walked through. One table and the keys are opened.
export async function accessible(page, what, rules) {
  await page.evaluate(() => {
    document.querySelectorAll(".still").forEach((drawing) => drawing.checkVisibility() || drawing.remove());
    for (const folded of [".data", "#controls details"])
      for (const found of [document.querySelector(folded)].filter(Boolean)) found.open = true;
  });
  await page.evaluate(AXE);
  const { violations } = await page.evaluate((rules) => axe.run(rules ? { runOnly: rules } : {}), rules);
  const told = violations.map((v) => `${v.id}: ${v.nodes.slice(0, 3).map((n) => n.html.slice(0, 120)).join(" ")}`);
  assert.deepEqual(told, [], what);
}
