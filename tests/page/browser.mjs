// Chromium without a window, driven over its DevTools protocol on a pipe: nothing to install besides
// the browser.
import {spawn} from "node:child_process";
import {mkdtempSync, rmSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";

const kSlow = 60000;  // ms; an answer that takes longer will not come

export class Browser {
  constructor(program) {
    this.folder = mkdtempSync(join(tmpdir(), "cablefit-browser-"));
    this.process = spawn(program, [
      "--headless=new", "--remote-debugging-pipe", "--no-sandbox", "--disable-gpu", "--no-first-run",
      "--disable-dev-shm-usage", "--disable-background-networking", "--disable-component-update",
      "--hide-scrollbars", `--user-data-dir=${this.folder}`, "about:blank"
    ], {stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"], env: {...process.env, HOME: this.folder}});
    this.waiting = new Map();
    this.listeners = [];
    this.next = 1;
    let rest = Buffer.alloc(0);
    this.process.stdio[4].on("data", (bytes) => {
      rest = Buffer.concat([rest, bytes]);
      for (let end = rest.indexOf(0); end >= 0; end = rest.indexOf(0)) {
        this.take(JSON.parse(rest.subarray(0, end).toString()));
        rest = rest.subarray(end + 1);
      }
    });
    this.process.stdio[3].on("error", () => {});  // told by "exit"
    this.process.on("exit", () => this.fail(new Error("the browser ended")));
    this.process.on("error", (error) => this.fail(error));
  }

  fail(error) {
    for (const {reject} of this.waiting.values()) reject(error);
    this.waiting.clear();
  }

  take(message) {
    const answer = this.waiting.get(message.id);
    if (!answer) return this.listeners.forEach((listener) => listener(message));
    this.waiting.delete(message.id);
    clearTimeout(answer.timer);
    if (message.error) answer.reject(new Error(`${answer.method}: ${message.error.message}`));
    else answer.resolve(message.result);
  }

  send(method, params = {}, sessionId = undefined) {
    return new Promise((resolve, reject) => {
      const id = this.next++;
      const timer = setTimeout(() => reject(new Error(`${method}: no answer`)), kSlow);
      this.waiting.set(id, {resolve, reject, method, timer});
      this.process.stdio[3].write(JSON.stringify({id, method, params, sessionId}) + "\0");
    });
  }

  /** A page at a URL, loaded; `dark`: for readers who prefer that; `scripts`: whether the page's run. */
  async open(url, {dark = false, width = 1280, height = 900, scripts = true} = {}) {
    const {targetId} = await this.send("Target.createTarget", {url: "about:blank"});
    const {sessionId} = await this.send("Target.attachToTarget", {targetId, flatten: true});
    const page = new Page(this, targetId, sessionId);
    for (const domain of ["Page", "Runtime", "Log", "Network"]) await page.send(`${domain}.enable`);
    await page.send("Emulation.setDeviceMetricsOverride", {width, height, deviceScaleFactor: 1, mobile: false});
    await page.send("Emulation.setEmulatedMedia",
                    {features: [{name: "prefers-color-scheme", value: dark ? "dark" : "light"}]});
    await page.send("Emulation.setScriptExecutionDisabled", {value: !scripts});
    const loaded = page.once("Page.loadEventFired");
    await page.send("Page.navigate", {url});
    await loaded;
    return page;
  }

  async close() {
    const ended = new Promise((resolve) => this.process.on("exit", resolve));
    await this.send("Browser.close").catch(() => {});
    await ended;
    rmSync(this.folder, {recursive: true, force: true, maxRetries: 5, retryDelay: 100});
  }
}

export class Page {
  constructor(browser, targetId, sessionId) {
    Object.assign(this, {browser, targetId, sessionId, errors: [], requests: []});
    browser.listeners.push((message) => {
      if (message.sessionId === sessionId) this.hear(message.method, message.params);
    });
  }

  hear(method, params) {
    if (method === "Runtime.exceptionThrown") {
      this.errors.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
    } else if (method === "Log.entryAdded" && ["error", "warning"].includes(params.entry.level)) {
      this.errors.push(params.entry.text);
    } else if (method === "Runtime.consoleAPICalled" && ["error", "warning"].includes(params.type)) {
      this.errors.push(params.args.map((arg) => arg.value ?? arg.description).join(" "));
    } else if (method === "Network.requestWillBeSent") {
      this.requests.push(params.request.url);
    } else if (method === "Page.javascriptDialogOpening") {
      this.errors.push("a dialog opened: " + params.message);
      this.send("Page.handleJavaScriptDialog", {accept: true});
    }
  }

  send(method, params) {
    return this.browser.send(method, params, this.sessionId);
  }

  once(method) {
    return new Promise((resolve) => {
      this.browser.listeners.push((message) => {
        if (message.sessionId === this.sessionId && message.method === method) resolve(message.params);
      });
    });
  }

  /** The value of an expression, a promise awaited. */
  async evaluate(expression) {
    const {result, exceptionDetails} = await this.send(
        "Runtime.evaluate", {expression, awaitPromise: true, returnByValue: true});
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  async mouse(type, x, y, more = {}) {
    await this.send("Input.dispatchMouseEvent", {type, x, y, button: "left", clickCount: 1, ...more});
  }

  async click(x, y) {
    await this.mouse("mouseMoved", x, y, {button: "none"});
    await this.mouse("mousePressed", x, y);
    await this.mouse("mouseReleased", x, y);
  }

  async drag(from, to) {
    await this.mouse("mouseMoved", ...from, {button: "none"});
    await this.mouse("mousePressed", ...from);
    for (const share of [0.3, 0.6, 1]) {
      await this.mouse("mouseMoved", from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1]),
                       {buttons: 1});
    }
    await this.mouse("mouseReleased", ...to);
  }

  async screenshot(whole = false) {
    const {data} = await this.send("Page.captureScreenshot", {format: "png", captureBeyondViewport: whole});
    return Buffer.from(data, "base64");
  }

  async pdf() {
    const {data} = await this.send("Page.printToPDF", {printBackground: true, preferCSSPageSize: true});
    return Buffer.from(data, "base64");
  }
}
