// Times every callback of the page, so that the work between two display frames can be added up.
(() => {
  const probe = (window.__probe = { frames: [], keys: [], painted: null });
  let work = 0, depth = 0;
  const timed = (callback) => typeof callback !== "function" ? callback : function (...given) {
    const start = performance.now();
    depth++;
    try { return callback.apply(this, given); }
    finally { if (--depth === 0) work += performance.now() - start; }
  };
  const nextFrame = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (callback) => nextFrame(timed(callback));
  const later = window.setTimeout.bind(window);
  window.setTimeout = (callback, ...rest) => later(timed(callback), ...rest);
  const wrapped = new WeakMap();
  const listen = EventTarget.prototype.addEventListener;
  EventTarget.prototype.addEventListener = function (type, listener, options) {
    if (typeof listener !== "function") return listen.call(this, type, listener, options);
    if (!wrapped.has(listener)) wrapped.set(listener, timed(listener));
    return listen.call(this, type, wrapped.get(listener), options);
  };
  const forget = EventTarget.prototype.removeEventListener;
  EventTarget.prototype.removeEventListener = function (type, listener, options) {
    return forget.call(this, type, wrapped.get(listener) ?? listener, options);
  };
  const port = Object.getOwnPropertyDescriptor(MessagePort.prototype, "onmessage");
  Object.defineProperty(MessagePort.prototype, "onmessage",
    { ...port, set(listener) { port.set.call(this, timed(listener)); } });

  const channel = new MessageChannel();
  let waiting = [];
  listen.call(channel.port1, "message", () => { const all = waiting; waiting = []; for (const call of all) call(); });
  channel.port1.start();
  // A message that is posted in a frame arrives once that frame is drawn.
  const afterThisFrame = (call) => { waiting.push(call); channel.port2.postMessage(null); };
  probe.afterPaint = (call) => nextFrame(() => afterThisFrame(call));

  const region = () => document.querySelector("[role=application]");
  // The region's name tells the image that it shows. Looked at as a frame begins: what is true then, that frame shows.
  probe.whenComplete = (before, call) => {
    const look = () => region()?.ariaBusy === "false" && region().ariaLabel !== before
      ? afterThisFrame(() => call(performance.now())) : nextFrame(look);
    nextFrame(look);
  };
  probe.whenComplete(null, (now) => { probe.painted = now; });
  listen.call(window, "keydown", (event) => {
    probe.afterPaint(() => probe.keys.push(performance.now() - event.timeStamp));
    probe.switched = null;
    probe.whenComplete(region()?.ariaLabel, (now) => { probe.switched = now - event.timeStamp; });
  }, true);
  const tick = (now) => { probe.frames.push([now, work]); work = 0; nextFrame(tick); };
  nextFrame(tick);
})()
