// The HTML reports in a browser: they draw without an error and without a network, they answer to
// mouse and legend, and nothing in a log gets to run.
// usage: node page_test.mjs CABLEFIT DATA CHROMIUM
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {copyFileSync, mkdtempSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {after, before, test} from "node:test";
import {pathToFileURL} from "node:url";
import {Browser} from "./browser.mjs";

const [program, data, chromium] = process.argv.slice(2);
const kMostBytes = 5e6;
const kDark = [21, 24, 28], kWhite = [255, 255, 255];  // --ground of page.css
let browser, folder;

const at = (...names) => names.map((name) => join(data, name));
const inFolder = (name) => join(folder, name);

function cablefit(...args) {
  execFileSync(program, [...args, "--quiet"], {cwd: folder, stdio: ["ignore", "ignore", "pipe"]});
}

/** One report of every command, in the order in which they need each other. */
const kCommands = {
  check: () => ["check", ...at("low/blocked.csv", "low/moving_load30.csv")],
  elastic: () => ["elastic", ...at("low/blocked.csv", "high/blocked.csv")],
  preloaded: () => ["elastic", "--out", "preloaded-out", ...at("high/blocked.csv"), "--rig", ...at("high/rig_cables.json")],
  dynamic: () => ["dynamic", ...at("low/moving_load30.csv", "low/moving_load-40.csv",
                                   "high/moving_load30.csv", "high/moving_load-40.csv")],
  rigid: () => ["dynamic", "--model", "rigid", "--out", "rigid-out", ...at("low/moving_load30.csv")],
  identify: () => ["identify", "--recursive", "--out", "identify-out",
                   ...at("low/blocked.csv", "low/moving_load30.csv", "high/blocked.csv", "high/moving_load30.csv")],
  simulate: () => ["simulate", "cablefit-out/dynamic.json", ...at("low/moving_load30.csv", "low/blocked.csv")],
  predict: () => ["predict", "cablefit-out/dynamic.json", ...at("low/moving_load30.csv")],
  refine: () => ["refine", ...at("low/blocked.csv", "low/moving_load30.csv", "low/moving_load-40.csv"),
                 "--draws", "8", "--out", "refine-out"],
  design: () => ["design", "cablefit-out/dynamic.json", "--preload", "high", "--torque", "20", "--out", "design-out"],
  compare: () => ["compare", "cablefit-out/dynamic.json", "cablefit-out/dynamic.json", "--preload", "low", "high"],
  batch: () => ["batch", ...at("campaign_strict.json")],
  fleet: () => ["batch", fleet(), "--out", "fleet-out"]
};

/** A campaign of two robots at four dates: the shipped logs, a different choice of them for each cell. */
function fleet() {
  const cells = [];
  for (const preload of ["low", "high"])
    ["2026-01-12", "2026-02-03T09:30", "2026-06-20", "2026-07-01"].forEach((date, k) => {
      const moving = [["load30"], ["load-40"], ["load30", "load-40"], ["load-40", "load30"]][k];
      cells.push({preload, date, robot: "arm " + (1 + k % 2), rig: at(preload + "/rig.json")[0],
                  blocked: at(preload + "/blocked.csv"), moving: at(...moving.map((load) => `${preload}/moving_${load}.csv`))});
    });
  writeFileSync(inFolder("fleet.json"), JSON.stringify({schema: "cablefit/campaign/1", name: "fleet", estimator: "wls", cells}));
  return "fleet.json";
}

/** Titles (with how often they occur) that the reports must have. */
const kResidualTitles = ["Torque error over time", "Distribution of the torque error",
                         "Autocorrelation of the torque error"];
const kWanted = {
  check: {Positions: 2, Torques: 2},
  elastic: {"Torque against deflection": 2, "Elastic torque of each cable": 2, "Force closure and disclosure over q and θ": 2, "Elastic error against deflection": 2, "Measured and predicted": 2,
            "Torque error against velocity of θ, linear": 2, "Torque error against position θ, linear": 2,
            "Torque error against deflection θ − q, linear": 2, ...counted(kResidualTitles, 2)},
  preloaded: {"Elastic torque of each cable": 1, "Stiffness against deflection": 1, "Force closure and disclosure over q and θ": 1},
  dynamic: {"Measured and predicted": 2, "Measured and predicted, close-up": 2,
            "Measured and predicted, poly": 2, "Measured and predicted, poly, close-up": 2, ...counted(kResidualTitles, 4),
            "Torque error against velocity of q, poly": 2, "Torque error against position θ, poly": 2,
            "Torque error against deflection θ − q, poly": 4, "Torque error against load τ_load, poly": 4},
  rigid: {"Measured and predicted": 1, ...counted(kResidualTitles, 1)},
  identify: {"Elastic torque of each cable": 2, "Force closure and disclosure over q and θ": 2, "Profile likelihood of l_o[1]": 2, "Profile likelihood of l_o[2]": 2, K1_0: 1, J_link: 2},
  simulate: {"Measured and simulated q": 2, "Measured and simulated q, close-up": 2, "Measured and simulated θ": 2, "Gap of q": 2, "Gap of θ": 2},
  predict: {"Elastic torques by the model": 1, "Contact torque on the link of joint 1": 1},
  refine: {"Mean residual against speed": 1, "Measured and simulated θ − q": 1},
  design: {"Elastic torque": 1, Stiffness: 1},
  compare: {"Difference B − A, in per cent of A": 1},
  batch: {K: 1, J_link: 1, "Torque against deflection": 2, "Torque error over time": 6},
  fleet: {K: 2, J_link: 2, "f_v": 2}
};

function counted(titles, times) {
  return Object.fromEntries(titles.map((title) => [title, times]));
}

async function open(name, options) {
  return browser.open(pathToFileURL(inFolder(name)).href, options);
}

function assertQuiet(page) {
  assert.deepEqual(page.errors, []);
  assert.deepEqual(page.requests.slice(1).filter((url) => !/^(data|blob):/.test(url)), []);
}

/** Folded plots have no size: everything is opened before all of it is drawn. */
const kDrawAll = `(() => {
  for (const fold of document.querySelectorAll("details")) fold.open = true;
  return cablefitReport.drawAll().then(() => true);
})()`;

/** Everything that is wrong with the plots as they are drawn, in words. */
const kComplaints = `(() => {
  const bad = [];
  const within = (inner, outer) => inner.left >= outer.left - 1 && inner.right <= outer.right + 1 &&
      inner.top >= outer.top - 1 && inner.bottom <= outer.bottom + 1;
  for (const {figure, place} of cablefitReport.plots) {
    const complain = (text) => bad.push(figure.group + ": " + figure.title + ": " + text);
    const box = place.getBoundingClientRect();
    const area = place.querySelector(".nsewdrag")?.getBoundingClientRect();
    if (!area) { complain("is not drawn"); continue; }
    if (area.height < 90 || area.width < 150) complain("has hardly any room");
    const traces = [...place.querySelectorAll(".scatterlayer .trace")];
    if (traces.length < figure.traces.length) complain("lacks a trace");
    for (const trace of traces) {
      const line = trace.querySelector("path.js-line");
      const hasLine = line && line.getAttribute("d").length > 10;
      if (!hasLine && !trace.querySelector("path.point")) complain("has an empty trace");
    }
    for (const axis of ["xtitle", "ytitle"]) {
      const title = place.querySelector("." + axis);
      if (!title || !title.textContent.trim()) complain("has no " + axis);
      else if (!within(title.getBoundingClientRect(), box)) complain("cuts its " + axis);
    }
    const legend = place.querySelector(".legend")?.getBoundingClientRect();
    if (figure.traces.length > 1 && !legend) complain("has no legend");
    if (legend && legend.bottom > area.top + 1) complain("has its legend over the curves");
    if (legend && !within(legend, box)) complain("cuts its legend");
    for (const note of place.querySelectorAll(".annotation")) {
      if (legend && note.getBoundingClientRect().top < legend.bottom - 1) complain("writes over its legend");
    }
  }
  return bad;
})()`;

before(() => {
  folder = mkdtempSync(join(tmpdir(), "cablefit-pages-"));
  browser = new Browser(chromium);
  for (const [name, words] of Object.entries(kCommands)) {
    try {
      cablefit(...words(), "--report", `${name}.html`);
    } catch (error) {
      if (!["batch", "compare"].includes(name) || error.status !== 1) throw error;  // gates fail, on purpose
    }
  }
});

after(async () => {
  await browser?.close();
  if (folder) rmSync(folder, {recursive: true, force: true});
});

for (const name of Object.keys(kCommands)) {
  test(`${name}: every plot is drawn`, async () => {
    assert.ok(statSync(inFolder(`${name}.html`)).size < kMostBytes);
    const page = await open(`${name}.html`);
    await page.evaluate(kDrawAll);
    const titles = await page.evaluate('[...document.querySelectorAll("figure strong")].map((s) => s.textContent)');
    for (const [title, times] of Object.entries(kWanted[name])) {
      assert.equal(titles.filter((one) => one === title).length, times, title);
    }
    assert.deepEqual(await page.evaluate(kComplaints), []);
    assertQuiet(page);
  });
}

const kScreens = [[1400, 900], [390, 844]];
const kMostBeforeFold = 20;

for (const name of Object.keys(kCommands)) {
  for (const [width, height] of kScreens) {
    test(`${name}: the first plot is on the first screen of ${width} px, and nothing sticks out`, async () => {
      const page = await open(`${name}.html`, {width, height});
      const {first, head, overflow, nShown} = await page.evaluate(`(() => {
        const figures = [...document.querySelectorAll("figure[data-figure]")];
        const box = (node) => { const b = node.getBoundingClientRect(); return {top: b.top, bottom: b.bottom}; };
        return {first: box(figures[0].querySelector(".plot")), head: box(document.querySelector(".verdict")),
                overflow: document.documentElement.scrollWidth - innerWidth,
                nShown: figures.filter((node) => !node.closest("details")).length};
      })()`);
      assert.ok(first.top > head.bottom - 1, "the verdict is not above the plot");
      assert.ok(first.bottom <= height, `the plot ends at ${first.bottom} px`);
      assert.equal(overflow, 0);
      assert.ok(nShown <= kMostBeforeFold, `${nShown} figures before the fold`);
    });
  }
}

test("refine begins with the gap: two plots before any table", async () => {
  const page = await open("refine.html");
  const titles = await page.evaluate(`[...document.querySelectorAll("figure")]
      .filter((figure) => !document.querySelector("table") ||
          figure.compareDocumentPosition(document.querySelector("table")) & Node.DOCUMENT_POSITION_FOLLOWING)
      .map((figure) => figure.querySelector("strong").textContent)`);
  assert.match(titles[0], /^Mean residual against/);
  assert.match(titles[1], /^Measured and simulated/);
});

test("batch says FAILED before anything else", async () => {
  const page = await open("batch.html");
  const text = await page.evaluate('document.querySelector(".short").innerText');
  assert.match(text, /^In short\s+FAILED/);
  const gates = await page.evaluate('[...document.querySelectorAll("td .badge")].map((node) => [node.textContent, node.className])');
  assert.ok(gates.some(([text, kind]) => text === "passed" && kind === "badge good"));
  assert.ok(gates.some(([text, kind]) => text === "FAILED" && kind === "badge bad"));
});

/** WCAG 2: relative luminance and contrast of two colours. */
function contrast(a, b) {
  const luminance = (text) => colour(text).map((v) => v / 255)
      .map((v) => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
      .reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
  const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
  return (high + 0.05) / (low + 0.05);
}

test("badges are readable in light and dark", async () => {
  for (const dark of [false, true]) {
    const page = await open("batch.html", {dark});
    const badges = await page.evaluate(`["good", "bad", "neutral", "warning"].map((kind) => {
      const badge = document.createElement("span");
      badge.className = "badge " + kind;
      document.body.append(badge);
      const style = getComputedStyle(badge);
      return [kind, style.color, style.backgroundColor];
    })`);
    for (const [kind, ink, ground] of badges) assert.ok(contrast(ink, ground) >= 4.5, `${kind}: ${ink} on ${ground}`);
  }
});

test("without JavaScript: all text, the tables and the main plot", async () => {
  const page = await open("dynamic.html", {scripts: false});
  const {root} = await page.send("DOM.getDocument", {depth: -1});
  const find = async (selector) => (await page.send("DOM.querySelectorAll", {nodeId: root.nodeId, selector})).nodeIds;
  assert.ok((await find("table tbody td")).length > 50);
  assert.equal((await find("figure.main svg")).length, 1);
  const [svg] = await find("figure.main svg");
  const {model} = await page.send("DOM.getBoxModel", {nodeId: svg});
  assert.ok(model.width > 300 && model.height > 150, "the plot has no room");
  // Places of plots that nobody draws are not shown.
  const [other] = await find("figure:not(.main)");
  await assert.rejects(page.send("DOM.getBoxModel", {nodeId: other}));
});

test("the first column of a wide table stays on a phone", async () => {
  const page = await open("check.html", {width: 390, height: 844});
  const [before, after, moved] = await page.evaluate(`(() => {
    const table = document.querySelector("main .scroll");
    const cell = table.querySelector("tbody td");
    const before = cell.getBoundingClientRect().left;
    table.scrollLeft = 200;
    return [before, cell.getBoundingClientRect().left, table.scrollLeft];
  })()`);
  assert.ok(moved > 100, "the table does not scroll");
  assert.ok(Math.abs(after - before) < 1, "the first column scrolls away");
});

test("a page says when, by what command and by which version it was made", async () => {
  const page = await open("elastic.html");
  const text = await page.evaluate('document.querySelector("header").innerText');
  assert.match(text, /\d{4}-\d\d-\d\d · cablefit \d+\.\d+/);
  assert.match(text, /cablefit elastic .*blocked\.csv .*--report elastic\.html/);
  const made = (...threads) => {
    execFileSync(program, ["elastic", ...at("low/blocked.csv"), "--quiet", "--report", "again.html", ...threads],
                 {cwd: folder, env: {...process.env, SOURCE_DATE_EPOCH: "86400"}, stdio: ["ignore", "ignore", "pipe"]});
    return readFileSync(inFolder("again.html"), "utf8");
  };
  const once = made("--threads", "1");
  assert.ok(once.includes("1970-01-02 · cablefit"));
  assert.equal(made("--threads", "2"), once);
});

test("dynamic prints on few pages", async () => {
  const page = await open("dynamic.html");
  const pdf = await page.pdf();
  assert.ok(pdf.length < 3e6, `${pdf.length} bytes`);
  const nPages = pdf.toString("latin1").match(/\/Type\s*\/Page\b/g).length;
  assert.ok(nPages <= 8, `${nPages} pages`);
});

test("plots appear as the reader comes to them, and links of the contents lead there", async () => {
  const page = await open("dynamic.html");
  const nDrawn = "cablefitReport.plots.filter((plot) => plot.isDrawn).length";
  const nAll = await page.evaluate("cablefitReport.plots.length");
  assert.ok(await page.evaluate(nDrawn) < nAll);
  await page.evaluate('document.documentElement.style.scrollBehavior = "auto"; ' +
                      '[...document.querySelectorAll("nav a")].at(-4).click(); ' +
                      "new Promise((done) => setTimeout(done, 1500))");
  const seen = await page.evaluate("cablefitReport.plots.filter(({place}) => { " +
      "const box = place.getBoundingClientRect(); return box.bottom > 0 && box.top < innerHeight; })" +
      ".every((plot) => plot.isDrawn)");
  assert.ok(seen);
  assertQuiet(page);
});

test("plots below the screen are drawn too, without scrolling", async () => {
  const page = await open("elastic.html");
  const nEmpty = `cablefitReport.plots.filter(({place, isDrawn}) => !isDrawn && !place.closest("details")).length`;
  for (let tries = 0; tries < 100 && await page.evaluate(nEmpty); ++tries)
    await new Promise((done) => setTimeout(done, 100));
  assert.equal(await page.evaluate(nEmpty), 0);
  assert.equal(await page.evaluate("scrollY"), 0);
  assertQuiet(page);
});

test("elastic begins with the errors of both models", async () => {
  const page = await open("elastic.html");
  const {title, traces} = await page.evaluate("cablefitReport.plots[0].figure");
  assert.equal(title, "Elastic error against deflection");
  assert.match(traces[0].name, /^linear, rms \d+\.\d+ N m$/);
  assert.match(traces[1].name, /^poly, order 2, rms 0\.\d+ N m$/);
});

/** Mean lightness, 0..255, of a strip `width` px wide that ends `offset` px left of the table's right edge. */
async function lightnessAtEdge(page, offset, width) {
  const box = await page.evaluate(`(() => {
    const box = document.querySelector("main .scroll").getBoundingClientRect();
    return {x: box.right + scrollX, y: box.top + scrollY, h: box.height};
  })()`);
  const clip = {x: box.x - offset - width, y: box.y + 0.4 * box.h, width, height: 0.3 * box.h, scale: 1};
  const {data} = await page.send("Page.captureScreenshot", {clip, captureBeyondViewport: true});
  return page.evaluate(`new Promise((done) => {
    const image = new Image();
    image.onload = () => {
      const canvas = document.createElement("canvas");
      [canvas.width, canvas.height] = [image.width, image.height];
      const context = canvas.getContext("2d");
      context.drawImage(image, 0, 0);
      const bytes = context.getImageData(0, 0, image.width, image.height).data;
      done(bytes.reduce((sum, byte) => sum + byte, 0) / bytes.length);
    };
    image.src = "data:image/png;base64,${data}";
  })`);
}

test("a shadow says that a table goes on at the right, until it ends", async () => {
  const page = await open("check.html", {width: 390, height: 844});
  const before = await lightnessAtEdge(page, 0, 4);
  await page.evaluate('(() => { const table = document.querySelector("main .scroll"); table.scrollLeft = table.scrollWidth; })()');
  const after = await lightnessAtEdge(page, 0, 4);
  assert.ok(before < after - 20, `${before} before, ${after} at the end`);
});

/** The first plot on the screen, and the middle of some of its parts. */
async function firstPlot(page) {
  await page.evaluate("document.documentElement.style.scrollBehavior = 'auto'; " +
                      "cablefitReport.plots[0].place.scrollIntoView({block: 'center'}); " +
                      "cablefitReport.drawAll().then(() => new Promise((done) => setTimeout(done, 300)))");
  return page.evaluate(`(() => {
    const place = cablefitReport.plots[0].place;
    const box = (node) => { const b = node.getBoundingClientRect(); return {x: b.x, y: b.y, w: b.width, h: b.height}; };
    return {area: box(place.querySelector(".nsewdrag")),
            legend: [...place.querySelectorAll(".legendtoggle")].map(box)};
  })()`);
}

const range = (page) => page.evaluate("[...cablefitReport.plots[0].place.layout.xaxis.range]");

test("dragging zooms, Reset shows everything again", async () => {
  const page = await open("elastic.html");
  const {area} = await firstPlot(page);
  const whole = await range(page);
  await page.drag([area.x + 0.3 * area.w, area.y + 0.3 * area.h], [area.x + 0.6 * area.w, area.y + 0.7 * area.h]);
  await page.evaluate("new Promise((done) => setTimeout(done, 400))");
  const zoomed = await range(page);
  const share = (zoomed[1] - zoomed[0]) / (whole[1] - whole[0]);
  assert.ok(Math.abs(share - 0.3) < 0.02, `${share} of the range is left`);
  await page.evaluate('document.querySelector("figure button").click()');
  await page.evaluate("new Promise((done) => setTimeout(done, 400))");
  assert.deepEqual(await range(page), whole);
  assertQuiet(page);
});

test("a click in the legend hides a trace, another shows it", async () => {
  const page = await open("elastic.html");
  const {legend} = await firstPlot(page);
  const visible = () => page.evaluate("cablefitReport.plots[0].place.data[1].visible ?? true");
  for (const wanted of ["legendonly", true]) {
    await page.click(legend[1].x + legend[1].w / 2, legend[1].y + legend[1].h / 2);
    await page.evaluate("new Promise((done) => setTimeout(done, 900))");  // it might be a double click
    assert.equal(await visible(), wanted);
  }
  assertQuiet(page);
});

test("the mouse over a curve tells its numbers", async () => {
  const page = await open("simulate.html");
  const {area} = await firstPlot(page);
  const text = () => page.evaluate('cablefitReport.plots[0].place.querySelector(".hoverlayer").textContent');
  for (let share = 0.1; share < 1 && !(await text()); share += 0.05) {
    await page.mouse("mouseMoved", area.x + area.w / 2, area.y + share * area.h, {button: "none"});
    await page.evaluate("new Promise((done) => setTimeout(done, 150))");
  }
  assert.match(await text(), /\d s.*rad/);
});

test("a plot is saved as SVG, on white", async () => {
  const page = await open("elastic.html", {dark: true});
  const downloads = mkdtempSync(inFolder("downloads-"));
  await browser.send("Browser.setDownloadBehavior", {behavior: "allow", downloadPath: downloads});
  await firstPlot(page);
  await page.evaluate('document.querySelectorAll("figure button")[1].click()');
  const saved = () => readdirSync(downloads).filter((name) => name.endsWith(".svg"));
  for (let tries = 0; tries < 50 && !saved().length; ++tries) await new Promise((done) => setTimeout(done, 100));
  assert.deepEqual(saved(), ["low_Blocked_link_elastic_torque_Elastic_error_against_deflection.svg"]);
  const svg = readFileSync(join(downloads, saved()[0]), "utf8");
  assert.ok(svg.startsWith("<svg "));
  assert.ok(svg.includes("fill: rgb(255, 255, 255)"), "the ground is not white");
  assertQuiet(page);
});

const colour = (text) => text.match(/\d+/g).slice(0, 3).map(Number);
const ground = async (page) => colour(await page.evaluate("getComputedStyle(document.body).backgroundColor"));
const plotGround = async (page) =>
    colour(await page.evaluate('cablefitReport.plots[0].place.querySelector(".main-svg").style.background'));

test("dark for readers who like it dark, light on paper", async () => {
  const page = await open("elastic.html", {dark: true});
  await firstPlot(page);
  assert.deepEqual(await ground(page), kDark);
  assert.deepEqual(await plotGround(page), kDark);
  await page.evaluate('dispatchEvent(new Event("beforeprint"))');
  assert.deepEqual(await ground(page), kWhite);
  assert.deepEqual(await plotGround(page), kWhite);
  await page.evaluate('dispatchEvent(new Event("afterprint"))');
  assert.deepEqual(await plotGround(page), kDark);
  await page.send("Emulation.setEmulatedMedia", {features: [{name: "prefers-color-scheme", value: "light"}]});
  await page.evaluate("new Promise((done) => setTimeout(done, 300))");
  assert.deepEqual(await plotGround(page), kWhite);
  const pdf = await page.pdf();
  assert.equal(pdf.subarray(0, 5).toString(), "%PDF-");
  assertQuiet(page);
});

test("a map names its regions, readable in light and dark", async () => {
  for (const dark of [false, true]) {
    const page = await open("preloaded.html", {dark});
    await page.evaluate(kDrawAll);
    const maps = await page.evaluate(`cablefitReport.plots.filter(({figure}) => figure.notes.length).map(({place}) => ({
      words: [...place.querySelectorAll(".annotation-text")].map((node) => node.textContent),
      ink: getComputedStyle([...place.querySelectorAll(".annotation-text")].at(-1)).fill,
      filled: getComputedStyle(place.querySelector(".js-fill")).fill,
    }))`);
    assert.equal(maps.length, 3);
    for (const {words, ink, filled} of maps) {
      for (const word of ["all taut", "slack: agonist", "slack: antagonist"]) assert.ok(words.includes(word), word);
      const lightness = (text) => colour(text).reduce((sum, part) => sum + part, 0) / 3;
      assert.ok(Math.abs(lightness(ink) - lightness(filled)) > 125, `${ink} on ${filled}`);
    }
    assert.deepEqual(await page.evaluate(kComplaints), []);
    assertQuiet(page);
  }
});

test("dates stand as far apart as they are, each bar at its own", async () => {
  const page = await open("fleet.html");
  await page.evaluate(kDrawAll);
  const axis = await page.evaluate(`(() => {
    const plot = cablefitReport.plots.find(({figure}) => figure.x.dates && figure.title === "J_link");
    return {type: plot.place.layout.xaxis.type, range: plot.place.layout.xaxis.range,
            names: plot.figure.traces.map((trace) => trace.name),
            x: plot.place.data[0].x, label: plot.place.data[0].customdata};
  })()`);
  assert.equal(axis.type, "date");
  assert.ok(axis.range[0] < "2026-01-12" && axis.range[1] > "2026-07-01");
  assert.deepEqual(axis.label, ["2026-01-12", "2026-06-20"]);
  const days = (Date.parse(axis.x[1] + "Z") - Date.parse(axis.x[0] + "Z")) / 86.4e6;
  assert.ok(Math.abs(days - 159) < 1e-3, `${days} days`);
  assert.ok(axis.names.includes("poly, high, arm 2"));
  assertQuiet(page);
});

/** A shipped log with a column, a preload and a name that would like to run. */
const kScript = "<script>alert(1)</script>";
const kImage = "</script><img src=x onerror=alert(2)>";

test("nothing in a log gets to run", async () => {
  const name = "a<img src=x onerror=alert(3)>'\".csv";
  const lines = readFileSync(at("low/blocked.csv")[0], "utf8").trimEnd().split("\n");
  const hostile = lines.map((line, k) => line + (k ? `,7,"${kImage}"` : `,${kScript},preload`));
  writeFileSync(inFolder(name), hostile.join("\n") + "\n");
  copyFileSync(at("low/rig.json")[0], inFolder("rig-of-it.json"));
  const rig = JSON.parse(readFileSync(inFolder("rig-of-it.json"), "utf8"));
  delete rig.preload;
  rig.cables = ["1", "2"].map((k) => ({
    name: `<b onclick=alert(4)>${k}</b>`, motor_radius: [k === "1" ? 1 : -1], link_radius: [k === "1" ? 1 : -1],
    law: "polynomial", order: 2, initial_elongation: 0
  }));
  writeFileSync(inFolder("rig-of-it.json"), JSON.stringify(rig));
  for (const command of ["check", "elastic"]) {
    cablefit(command, name, "--rig", "rig-of-it.json", "--out", "hostile-out", "--report", `hostile-${command}.html`);
    const page = await open(`hostile-${command}.html`);
    await page.evaluate(kDrawAll);
    await page.evaluate("new Promise((done) => setTimeout(done, 500))");
    assert.deepEqual(await page.evaluate(kComplaints), []);
    assertQuiet(page);
    assert.equal(await page.evaluate('document.querySelectorAll("img, b, [onclick], [onerror]").length'), 0);
    assert.equal(await page.evaluate("document.scripts.length"), 3);
    const text = await page.evaluate("document.body.innerText");
    assert.ok(text.includes(kImage), "the preload is not told as it is");
    if (command === "check") assert.ok(text.includes(kScript), "the column is not told as it is");
  }
});
