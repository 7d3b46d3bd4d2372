"use strict";
/* The page of a study. plan.js has set window.STUDY: the texts, the names of the videos, and the pages of every session. What a
   participant has answered is kept in this browser until it is sent, so that a reload goes on where it stopped. */
(() => {
  const study = window.STUDY;
  const asked = new URLSearchParams(location.search);
  const served = location.protocol !== "file:";
  const seat = /^[1-9]\d{0,5}$/.test(asked.get("p") || "") ? Number(asked.get("p")) : null;
  const place = `wm-study-${study.study}-${seat ?? "any"}`;
  const main = document.getElementById("main");
  const [top, bottom, where, progress, hint, replay, next] =
    ["top", "bottom", "where", "progress", "hint", "replay", "next"].map((id) => document.getElementById(id));
  const pool = new Map(); // videos that are loading or shown, by their name and side
  let state = load();
  let page = null; // what is shown now: its trial, its videos, its answers so far

  document.title = study.title;
  document.addEventListener("keydown", key);
  replay.addEventListener("click", () => play(true));
  next.addEventListener("click", leave);
  show();

  /* State: kept after every page. */
  function load() {
    try {
      const kept = JSON.parse(localStorage.getItem(place));
      if (kept && Array.isArray(kept.answers) && study.sessions[kept.slot]) return kept;
    } catch { /* no storage: the study works, but does not survive a reload */ }
    return null;
  }
  function keep() {
    try { localStorage.setItem(place, JSON.stringify(state)); } catch { /* as above */ }
  }
  async function begin() {
    const bytes = crypto.getRandomValues(new Uint8Array(16));
    const participant = [...bytes].map((byte) => byte.toString(16).padStart(2, "0")).join("");
    state = { version: 1, study: study.study, participant, slot: await slot(), answers: [], sent: false };
    keep();
    show();
  }
  async function slot() {
    const count = study.sessions.length;
    if (seat !== null) return (seat - 1) % count;
    if (served) {
      try {
        const reply = await fetch("slot", { cache: "no-store" });
        const given = reply.ok ? (await reply.json()).slot : null;
        if (Number.isInteger(given) && study.sessions[given]) return given;
      } catch { /* another server than serve.py: the session is drawn here */ }
    }
    return crypto.getRandomValues(new Uint32Array(1))[0] % count;
  }

  /* Pages. */
  function element(tag, attributes = {}, ...children) {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
      if (typeof value === "function") made.addEventListener(name, value);
      else if (value !== false) made.setAttribute(name, value === true ? "" : value);
    }
    made.append(...children);
    return made;
  }
  function show() {
    const trials = state && study.sessions[state.slot];
    const running = Boolean(state) && state.answers.length < trials.length;
    top.hidden = bottom.hidden = !running;
    page = null;
    if (!state) welcome();
    else if (running) trial(trials, state.answers.length);
    else finish();
    main.focus({ preventScroll: true });
    scrollTo(0, 0);
  }
  function welcome() {
    const start = element("button", { type: "button", class: "strong", id: "start", click: (event) => { event.target.disabled = true; begin(); } },
      "I agree, start ", element("kbd", {}, "Enter"));
    main.replaceChildren(element("div", { class: "words" },
      element("h1", {}, study.title),
      ...study.consent.map((text) => element("p", {}, text)),
      element("div", { class: "buttons" }, start),
      element("p", { class: "quiet" }, element("span", { class: "keys" }, keyboardHelp()), "You can reload the page at any time and go on where you were.")));
  }
  function keyboardHelp() {
    const pairs = study.preference ? " ← and → choose one of two videos;" : "";
    return `With a keyboard: 1 to 5 rate,${pairs} Space plays again, Enter goes on. `;
  }
  function trial(trials, number) {
    const now = trials[number];
    page = { trial: now, began: performance.now(), plays: 0, ended: new Set(), answers: {}, broken: false };
    where.textContent = `${number + 1} of ${trials.length}`;
    progress.value = number / trials.length;
    page.videos = now.videos.map((name, side) => video(name, side));
    (now.videos.length === 1 ? rating : pair)(now);
    for (const shown of page.videos) watch(shown);
    forget(now.videos, trials[number + 1]?.videos ?? []);
    update();
    start();
  }
  function note(text) {
    return text ? [element("p", { class: "note" }, text)] : [];
  }
  function rating(now) {
    const told = now.check && `This page checks attention. Please choose ${now.check} for every question here.`;
    const questions = element("div", { id: "questions" }, ...note(told), ...study.ratings.map(scale));
    main.replaceChildren(element("div", { class: "rating" }, element("div", {}, ...page.videos), questions));
  }
  function scale(question) {
    const about = `about-${question.id}`;
    const choice = (value) => element("label", {},
      element("input", { type: "radio", name: question.id, value, change: () => answer(question.id, value),
        "aria-label": `${question.title}: ${value} of 5` + (value === 1 ? `, ${question.low}` : value === 5 ? `, ${question.high}` : "") }),
      element("span", {}, String(value)));
    return element("fieldset", { id: `ask-${question.id}`, "aria-describedby": about, focusin: () => current(question.id) },
      element("legend", {}, question.title), element("p", { id: about }, question.question),
      element("div", { class: "scale" }, ...[1, 2, 3, 4, 5].map(choice)),
      element("div", { class: "ends", "aria-hidden": "true" }, element("span", {}, question.low), element("span", {}, question.high)));
  }
  function pair(now) {
    const letters = { left: "A", right: "B" };
    const told = now.check && `This page checks attention. Please choose ${letters[now.check]}, whatever you see.`;
    const side = (name, index) => element("label", { class: "side", "data-side": name }, page.videos[index],
      element("input", { type: "radio", name: "choice", value: name, "aria-label": `Video ${letters[name]}`, change: () => answer("choice", name) }),
      element("span", {}, letters[name], " ", element("kbd", {}, name === "left" ? "←" : "→")));
    main.replaceChildren(element("h2", { id: "ask" }, study.preference), ...note(told),
      element("div", { class: "pair", role: "radiogroup", "aria-labelledby": "ask" }, side("left", 0), side("right", 1)));
  }

  /* Videos: those of the next page load while this one is shown, and the same elements are then shown. */
  function video(name, side) {
    const place = `${name}/${side}`;
    if (!pool.has(place)) {
      const [width, height] = study.videos[name];
      const made = element("video", { preload: "auto", playsinline: true, muted: true, width, height, src: `videos/${name}.mp4` });
      made.muted = true;
      made.disablePictureInPicture = true;
      pool.set(place, made);
    }
    return pool.get(place);
  }
  function forget(shown, coming) {
    coming.forEach(video);
    const wanted = new Set([...shown, ...coming].flatMap((name) => [`${name}/0`, `${name}/1`]));
    for (const [place, kept] of pool) {
      if (wanted.has(place)) continue;
      kept.removeAttribute("src");
      kept.load();
      pool.delete(place);
    }
  }
  function watch(shown) {
    const mine = page;
    const number = page.videos.indexOf(shown);
    shown.setAttribute("aria-label", page.videos.length === 1 ? "The video to rate" : `Video ${"AB"[number]}`);
    shown.onended = () => { mine.ended.add(number); if (mine === page) update(); };
    shown.ontimeupdate = () => { if (mine === page) align(shown); };
    shown.onerror = () => { if (mine === page) failed(); };
    if (shown.error) failed();
  }
  function start() {
    const mine = page;
    const ready = (shown) => shown.readyState >= 3 ? Promise.resolve()
      : new Promise((done) => shown.addEventListener("canplay", done, { once: true }));
    Promise.all(page.videos.map(ready)).then(() => { if (mine === page) play(true); });
  }
  function play(again) {
    if (!page || page.broken) return;
    if (again) page.plays += 1;
    for (const shown of page.videos) {
      if (again) shown.currentTime = 0;
      shown.play().catch(() => { hint.textContent = "Press Replay to play."; });
    }
  }
  /* Two videos run together: the second follows the first, and both wait while one is loading. */
  function align(shown) {
    const [first, second] = page.videos;
    if (!second || shown !== first || first.ended || second.ended || first.seeking || second.seeking) return;
    if (second.readyState < 3) { first.pause(); second.addEventListener("canplay", () => play(false), { once: true }); return; }
    if (Math.abs(first.currentTime - second.currentTime) > 0.12) second.currentTime = first.currentTime;
  }
  function failed() {
    page.broken = true;
    if (!document.querySelector(".broken")) {
      main.append(element("p", { class: "broken", role: "alert" }, "This video cannot be played in your browser. Please go on with Next; the page is not counted."));
    }
    update();
  }

  /* Answers. */
  function answer(question, value) {
    page.answers[question] = value;
    const input = main.querySelector(`input[name="${question}"][value="${value}"]`);
    input.checked = true;
    update();
  }
  function current(id) {
    page.current = id;
    for (const group of main.querySelectorAll("fieldset")) group.classList.toggle("current", group.id === `ask-${id}`);
  }
  function open() {
    return page.videos.length === 1 ? study.ratings.filter((question) => !(question.id in page.answers)).map((question) => question.id)
      : "choice" in page.answers ? [] : ["choice"];
  }
  function seen() {
    return !study.must_watch || page.ended.size === page.videos.length;
  }
  function update() {
    const left = open();
    next.disabled = !(page.broken || (left.length === 0 && seen()));
    hint.textContent = page.broken ? "" : !seen() ? "Please watch to the end." : left.length ? (page.videos.length === 1 ? "Please answer every question." : "Please choose A or B.") : "";
    if (page.videos.length === 1 && (!page.current || !left.includes(page.current))) current(left[0] ?? null);
  }
  function leave() {
    if (!page || next.disabled) return;
    for (const shown of page.videos) { shown.pause(); shown.onended = shown.ontimeupdate = shown.onerror = null; }
    const seconds = Math.round((performance.now() - page.began) / 100) / 10;
    const given = page.broken ? { unseen: true } : page.videos.length === 1 ? { ratings: page.answers } : { choice: page.answers.choice };
    state.answers.push({ ...given, seconds, plays: page.plays });
    keep();
    show();
  }
  function key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || event.repeat) return;
    const button = event.target.closest?.("button, a");
    if (event.key === "Enter" && !button) {
      const go = page ? next : document.getElementById("start");
      if (go && !go.disabled) { event.preventDefault(); go.click(); }
    } else if (page && event.key === " " && !button) {
      event.preventDefault();
      play(true);
    } else if (page && page.videos.length === 1 && /^[1-5]$/.test(event.key) && (page.current || open()[0])) {
      event.preventDefault();
      const id = page.current || open()[0];
      const focused = document.activeElement?.name === id;
      answer(id, Number(event.key));
      if (focused) main.focus({ preventScroll: true });
    } else if (page && page.videos.length === 2 && (event.key === "ArrowLeft" || event.key === "ArrowRight")) {
      event.preventDefault();
      answer("choice", event.key === "ArrowLeft" ? "left" : "right");
    }
  }

  /* The end: answers go to the server where there is one, and can be downloaded always. */
  function packed() {
    const { sent, ...answers } = state;
    return JSON.stringify(answers);
  }
  function finish() {
    forget([], []);
    const told = element("p", { id: "told", role: "status" }, "");
    const save = element("button", { type: "button", id: "download", click: download }, "Download my answers");
    const again = element("button", { type: "button", id: "again", click: other }, "Next participant on this device");
    main.replaceChildren(element("div", { class: "words" }, element("h1", {}, study.thanks), told,
      element("div", { class: "buttons" }, save, again), element("p", { class: "quiet" }, `Your number is ${state.participant}.`)));
    send(told, save);
  }
  async function send(told, save) {
    if (!state.sent && served) {
      told.textContent = "Sending your answers …";
      try {
        const reply = await fetch("answers", { method: "POST", headers: { "Content-Type": "application/json" }, body: packed() });
        state.sent = reply.ok && (await reply.json()).stored === true;
        keep();
      } catch { /* told below */ }
    }
    told.textContent = state.sent ? "Your answers are stored. You can close this page." : `Please download your answers. ${study.send_to}`;
    save.classList.toggle("strong", !state.sent);
  }
  function download() {
    const address = URL.createObjectURL(new Blob([packed()], { type: "application/json" }));
    element("a", { href: address, download: `answers-${state.participant}.json` }).click();
    setTimeout(() => URL.revokeObjectURL(address), 10000);
  }
  function other() {
    if (!state.sent && !confirm("The answers on this device will be forgotten. Have you downloaded them?")) return;
    try { localStorage.removeItem(place); } catch { /* nothing was kept */ }
    state = null;
    show();
  }
})();
