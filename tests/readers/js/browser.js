// Drives a headless Chromium by the DevTools protocol over a pipe. Needs node 18 and nothing else.
//
//     const {launch} = require('./browser');
//     const {serve} = require('./server');
//     const server = await serve({'/': folder});
//     const browser = await launch();                  // or launch({program: '/usr/bin/chromium'})
//     const page = await browser.open(server.url + 'index.html');
//     await page.wait('window.ready === true');        // any expression; 30 seconds by default
//     const sum = await page.evaluate('1 + 1');        // an expression, or a promise of a value
//     const same = await page.evaluate((a, b) => a + b, 1, 1);  // or a function with JSON
//     arguments
//     await page.screenshot('page.png');
//     page.messages                                    // [{type: 'error', text: '...'}, ...]
//     await browser.close();
//     await server.close();
//
// Everything rejects with an Error that says what failed: launch() when the program does not
// start, evaluate() when the page throws, wait() when the time is over. close() ends the browser
// and removes its profile; it may be called at any time, also twice.
'use strict';

const {spawn} = require('child_process');
const fs = require('fs');
const os = require('os');
const path = require('path');

const FLAGS = [
  '--headless=new', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run',
  '--disable-background-networking', '--disable-component-update', '--disable-sync',
  '--disable-dev-shm-usage', '--disable-extensions', '--hide-scrollbars',
  '--autoplay-policy=no-user-gesture-required', '--remote-debugging-pipe',
];

const sleep = (ms) => new Promise((done) => setTimeout(done, ms));

// Messages are JSON, each ended by a zero byte; commands carry an id that the answer repeats.
class Connection {
  constructor(child) {
    this.out = child.stdio[3];
    this.pending = new Map();
    this.listeners = [];
    this.last = 0;
    this.dead = null;
    let rest = Buffer.alloc(0);
    child.stdio[4].on('data', (block) => {
      rest = Buffer.concat([rest, block]);
      for (let end; (end = rest.indexOf(0)) >= 0; rest = rest.subarray(end + 1)) {
        this.receive(JSON.parse(rest.subarray(0, end).toString()));
      }
    });
    this.out.on('error', (error) => this.fail(error));
    child.stdio[4].on('error', (error) => this.fail(error));
    child.on('error', (error) => this.fail(error));
    child.on('exit', (code, signal) => {
      this.fail(new Error(`the browser ended (${signal || code})`));
    });
  }

  receive(message) {
    if (message.id === undefined) {
      for (const listener of [...this.listeners]) listener(message);
      return;
    }
    const {resolve, reject, method} = this.pending.get(message.id) || {};
    this.pending.delete(message.id);
    if (!resolve) return;
    if (message.error) reject(new Error(`${method}: ${message.error.message}`));
    else resolve(message.result);
  }

  fail(error) {
    this.dead = this.dead || error;
    for (const {reject} of this.pending.values()) reject(this.dead);
    this.pending.clear();
  }

  send(method, params = {}, sessionId = undefined) {
    if (this.dead) return Promise.reject(this.dead);
    return new Promise((resolve, reject) => {
      const id = ++this.last;
      this.pending.set(id, {resolve, reject, method});
      this.out.write(JSON.stringify({id, method, params, sessionId}) + '\0');
    });
  }
}

/** One tab. */
class Page {
  constructor(connection, session, target) {
    this.connection = connection;
    this.session = session;
    this.target = target;
    /** What the page said: console calls and the browser's own log {type, text}; an exception
        that nobody caught has type 'exception'. */
    this.messages = [];
    connection.listeners.push((message) => {
      if (message.sessionId === session) this.hear(message.method, message.params);
    });
  }

  hear(method, params) {
    if (method === 'Runtime.consoleAPICalled') {
      const text = params.args.map((a) => (a.value === undefined ? a.description : a.value));
      this.messages.push({type: params.type, text: text.join(' ')});
    } else if (method === 'Runtime.exceptionThrown') {
      this.messages.push({type: 'exception', text: describe(params.exceptionDetails)});
    } else if (method === 'Log.entryAdded') {
      const {level, text, url} = params.entry;
      this.messages.push({type: level, text: url ? `${text} (${url})` : text});
    }
  }

  /** A command of the protocol itself, e.g. 'Input.dispatchKeyEvent'. */
  send(method, params) {
    return this.connection.send(method, params, this.session);
  }

  /** Goes to an address and waits for the load event of the new document. */
  async goto(url) {
    const loaded = this.next('Page.loadEventFired');
    const {errorText} = await this.send('Page.navigate', {url});
    if (errorText) throw new Error(`${url}: ${errorText}`);
    if (!await loaded) throw new Error(`${url} is not loaded after 30 s`);
  }

  /** The parameters of the next event of a name; undefined if none comes within `seconds`. */
  next(method, seconds = 30) {
    return new Promise((done) => {
      const timer = setTimeout(done, seconds * 1000);
      const listener = (message) => {
        if (message.sessionId !== this.session || message.method !== method) return;
        clearTimeout(timer);
        const {listeners} = this.connection;
        listeners.splice(listeners.indexOf(listener), 1);
        done(message.params);
      };
      this.connection.listeners.push(listener);
    });
  }

  /** The value of an expression, or of a function called with arguments; both may be promises of
      it. Values and arguments are what JSON can hold. Counts as a gesture of the user. */
  async evaluate(what, ...args) {
    const expression = typeof what === 'function' ?
        `(${what})(...${JSON.stringify(args)})` : what;
    const {result, exceptionDetails} = await this.send('Runtime.evaluate', {
      expression, awaitPromise: true, returnByValue: true, userGesture: true,
    });
    if (exceptionDetails) throw new Error(describe(exceptionDetails));
    return result.value;
  }

  /** Asks an expression or a function again and again until it is true; its value. */
  async wait(what, {seconds = 30, args = []} = {}) {
    const end = Date.now() + seconds * 1000;
    for (;;) {
      const value = await this.evaluate(what, ...args);
      if (value) return value;
      if (Date.now() > end) throw new Error(`not true within ${seconds} s: ${what}`);
      await sleep(20);
    }
  }

  /** The size of the window in CSS pixels, and how many pixels each of them has. */
  async resize(width, height, scale = 1) {
    await this.send('Emulation.setDeviceMetricsOverride',
        {width, height, deviceScaleFactor: scale, mobile: false});
  }

  /** A PNG of what is seen; its bytes, also written to `file` where that is given. */
  async screenshot(file) {
    const {data} = await this.send('Page.captureScreenshot', {format: 'png'});
    const bytes = Buffer.from(data, 'base64');
    if (file) fs.writeFileSync(file, bytes);
    return bytes;
  }

  async close() {
    await this.connection.send('Target.closeTarget', {targetId: this.target});
  }
}

function describe(details) {
  const thrown = details.exception;
  return (thrown && (thrown.description || String(thrown.value))) || details.text;
}

class Browser {
  constructor(child, profile) {
    this.child = child;
    this.profile = profile;
    this.connection = new Connection(child);
    this.ended = new Promise((done) => {
      child.on('exit', done);
      child.on('error', done);
    });
  }

  /** A new tab at an address; rejects when it cannot be loaded. */
  async open(url = 'about:blank') {
    const {connection} = this;
    const {targetId} = await connection.send('Target.createTarget', {url: 'about:blank'});
    const {sessionId} = await connection.send('Target.attachToTarget', {targetId, flatten: true});
    const page = new Page(connection, sessionId, targetId);
    for (const domain of ['Page', 'Runtime', 'Log']) await page.send(`${domain}.enable`);
    if (url !== 'about:blank') await page.goto(url);
    return page;
  }

  async close() {
    this.connection.send('Browser.close').catch(() => {});
    const slow = setTimeout(() => this.child.kill('SIGKILL'), 5000);
    await this.ended;
    clearTimeout(slow);
    fs.rmSync(this.profile, {recursive: true, force: true, maxRetries: 5, retryDelay: 100});
  }
}

/** Starts a browser with a fresh profile. `flags`: further command line flags. */
async function launch({program = process.env.CHROMIUM || 'chromium', flags = []} = {}) {
  const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'animeme-browser-'));
  const child = spawn(program, [...FLAGS, `--user-data-dir=${profile}`, ...flags, 'about:blank'],
      {stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe']});
  const browser = new Browser(child, profile);
  try {
    browser.version = (await browser.connection.send('Browser.getVersion')).product;
  } catch (error) {
    await browser.close();
    throw new Error(`${program}: ${error.message}`);
  }
  return browser;
}

module.exports = {launch, sleep};
