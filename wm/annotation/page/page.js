"use strict";
// The page of one run. What is confirmed is on the server's disk; clicks that are not confirmed are here alone.

const COLORS = ["#e6194b", "#3cb44b", "#4363d8", "#f58231", "#911eb4", "#0aa5a5", "#d61fc4", "#7a8f00", "#9a6324", "#1f77b4"];
const $ = (id) => document.getElementById(id);
const view = { images: [], chosen: 0, things: [], outcome: 0, finished: false, clicks: [], current: null, replaces: null, asked: 0 };

const image = () => view.images[view.chosen];
const color = () => (view.replaces === null ? view.things.length : view.replaces) % COLORS.length;

function say(text, isError = false) {
  $("message").textContent = text;
  $("message").classList.toggle("error", isError);
}

async function ask(path, body) {
  const options = body && { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) };
  let reply, answer;
  try {
    reply = await fetch(path, options);
    answer = await reply.json();
  } catch {
    throw new Error("wm.annotate does not answer; is it still running? What is confirmed is saved.");
  }
  if (!reply.ok) throw new Error(answer.error);
  return answer;
}

async function guarded(work) {
  try {
    await work();
  } catch (error) {
    say(error.message, true);
  }
}

// ---- what is asked of the server

const about = (more) => ({ image: image().name, digest: image().digest, ...more });

async function load() {
  const answer = await ask("images");
  $("run").textContent = answer.run;
  view.images = answer.images;
  if (!view.images.length) throw new Error("This run has no drawings.");
  const next = view.images.findIndex((one) => !one.finished);
  await choose(Math.max(next, 0));
}

async function choose(number) {
  view.chosen = (number + view.images.length) % view.images.length;
  Object.assign(view, { things: [], outcome: 0, finished: image().finished });
  reset();
  $("picture").src = "picture/" + image().name + "?" + image().digest;
  draw();
  say(image().marked ? "Segmenting what is marked ..." : "");
  const here = image();
  const answer = await ask("things", about());
  if (here !== image()) return;
  take(answer);
  say("");
}

function take(answer) {
  Object.assign(view, { things: answer.things, outcome: answer.outcome, finished: answer.finished });
  Object.assign(image(), { marked: view.things.length, finished: view.finished });
  draw();
}

function reset() {
  Object.assign(view, { clicks: [], current: null, replaces: null, asked: view.asked + 1 });
  $("label").value = "";
}

async function segment() {
  const number = ++view.asked;
  draw();
  if (!view.clicks.some((click) => click[2] === "+")) {
    view.current = null;
    say(view.clicks.length ? "Click on the thing as well: these clicks only say what it is not." : "");
    draw();
    return;
  }
  say("Segmenting ... (the first time, the model is loaded)");
  const answer = await ask("mask", about({ clicks: view.clicks, label: $("label").value, color: color() }));
  if (number !== view.asked) return; // a newer click was made, or the image left
  view.current = answer;
  say("");
  draw();
}

async function confirmThing() {
  const label = $("label").value.trim();
  if (!view.current) return say("Click on a thing first.", true);
  if (!label) {
    $("label").focus();
    return say("Say what it is: type a label, or choose one.", true);
  }
  const answer = await ask("confirm", about({ clicks: view.clicks, label, replaces: view.replaces }));
  $("label").blur();
  reset();
  take(answer);
  say("Saved: " + label + ".");
}

async function remove(number) {
  const label = view.things[number].label;
  const answer = await ask("delete", about({ thing: number }));
  reset();
  take(answer);
  say("Deleted: " + label + ".");
}

async function finish() {
  take(await ask("finish", about({ finished: !view.finished })));
  const open = view.images.filter((one) => !one.finished).length;
  if (!view.finished) return say("");
  say(open ? "Finished; " + open + " to go." : "All images are finished: the same run command now goes on. You can close this page.");
  if (open) await choose(view.chosen + 1 + [...view.images.slice(view.chosen + 1), ...view.images].findIndex((one) => !one.finished));
}

function undo() {
  view.clicks.pop();
  return segment();
}

function edit(number) {
  reset();
  Object.assign(view, { replaces: number, clicks: view.things[number].clicks.map((click) => [...click]) });
  $("label").value = view.things[number].label;
  return segment();
}

// ---- what is shown

function named(name) {
  $("label").value = name;
  $("label").focus(); // so that Enter confirms
}

function element(tag, text, properties = {}) {
  return Object.assign(document.createElement(tag), { textContent: text, ...properties });
}

function fit() {
  const picture = image();
  if (!picture) return;
  const scale = Math.min($("stage").clientWidth / picture.width, $("stage").clientHeight / picture.height);
  $("picture").style.width = Math.max(Math.floor(picture.width * scale), 1) + "px";
  $("picture").style.height = Math.max(Math.floor(picture.height * scale), 1) + "px";
}

function draw() {
  const done = view.images.filter((one) => one.finished).length;
  $("progress").textContent = done + " of " + view.images.length + " images finished";
  $("images").replaceChildren(...view.images.map(imageRow));
  const faint = view.clicks.length ? "faint" : "";
  const others = view.things.filter((_, k) => k !== view.replaces).map((thing) => thing.overlay);
  const overlays = others.map((src) => element("img", "", { src, alt: "", className: faint }));
  if (view.current) overlays.push(element("img", "", { src: view.current.overlay, alt: "", id: "mask" }));
  $("overlays").replaceChildren(...overlays);
  $("dots").replaceChildren(...view.clicks.map(dot));
  $("current").textContent = view.replaces === null ? "New thing" : "Change: " + view.things[view.replaces].label;
  $("fact").textContent = fact();
  $("confirm").disabled = !view.current;
  $("undo").disabled = $("clear").disabled = !view.clicks.length;
  const names = [...new Set([...view.things.map((thing) => thing.label), ...(image() ? image().suggestions : [])])];
  $("names").replaceChildren(...names.map((name) => element("option", "", { value: name })));
  $("chips").replaceChildren(...names.map((name) => element("button", name, { onclick: () => named(name) })));
  $("things").replaceChildren(...view.things.map(thingRow));
  $("outcome").textContent = outcome();
  $("finish").textContent = view.finished ? "Not finished after all" : "This image is finished";
  $("finish").classList.toggle("strong", !view.finished);
  fit();
}

function spoken(name) {
  return name.replace(/\/furnish(\d+)$/, (_, number) => " " + (Number(number) + 1)).replaceAll("_", " ");
}

function imageRow(one, number) {
  const row = element("li", "", { className: number === view.chosen ? "chosen" : "", tabIndex: 0 });
  row.append(element("b", spoken(one.name)), element("small", (one.finished ? "\u2713 " : "") + one.marked));
  row.title = one.name;
  row.onclick = () => guarded(() => choose(number));
  row.onkeydown = (event) => event.key === "Enter" && (event.stopPropagation(), row.onclick());
  return row;
}

function thingRow(thing, number) {
  const row = element("li", "", { className: number === view.replaces ? "chosen" : "", tabIndex: 0 });
  const swatch = element("i", "");
  swatch.style.background = COLORS[number % COLORS.length];
  const cross = element("button", "\u00d7", { title: "delete", ariaLabel: "delete " + thing.label });
  cross.onclick = (event) => (event.stopPropagation(), guarded(() => remove(number)));
  row.append(swatch, element("span", thing.label), cross);
  row.onclick = () => guarded(() => edit(number));
  row.onkeydown = (event) => event.key === "Enter" && event.target === row && (event.stopPropagation(), row.onclick());
  return row;
}

function dot([x, y, sign]) {
  const mark = element("i", "", { className: sign === "-" ? "beside" : "" });
  mark.style.left = (100 * x) / image().width + "%";
  mark.style.top = (100 * y) / image().height + "%";
  return mark;
}

function fact() {
  if (!view.clicks.length) return "Click at a thing in the image.";
  if (!view.current) return "";
  if (view.current.building) return "Walls, doors and windows are there already: this would be left out.";
  if (!view.current.pieces) return "Too small: this would be left out.";
  const size = (100 * view.current.share).toFixed(1) + " % of the image, score " + view.current.score.toFixed(2);
  const apart = view.current.pieces > 1 ? "; in " + view.current.pieces + " pieces, which become things of their own unless something nearer divides them" : "";
  return size + apart + ".";
}

function outcome() {
  if (!view.things.length) return "Nothing yet. An image without furniture is finished as it is.";
  return view.outcome === view.things.length ? "" : view.things.length + " marked, " + view.outcome + " after small ones are left out, overlapping ones of one name joined, and pieces divided.";
}

// ---- what the person does

$("frame").addEventListener("pointerdown", (event) => {
  if (event.button !== 0 && event.button !== 2) return;
  event.preventDefault();
  if (document.activeElement) document.activeElement.blur();
  const box = $("picture").getBoundingClientRect();
  const at = (from, size, pixels) => Math.min(Math.max(Math.round((100 * from * pixels) / size) / 100, 0), pixels);
  const x = at(event.clientX - box.left, box.width, image().width);
  const y = at(event.clientY - box.top, box.height, image().height);
  view.clicks.push([x, y, event.shiftKey || event.button === 2 ? "-" : "+"]);
  guarded(segment);
});
$("frame").addEventListener("contextmenu", (event) => event.preventDefault());
$("confirm").onclick = () => guarded(confirmThing);
$("undo").onclick = () => guarded(undo);
$("clear").onclick = () => (reset(), draw(), say(""));
$("finish").onclick = () => guarded(finish);
addEventListener("resize", fit);
addEventListener("beforeunload", (event) => view.clicks.length && view.replaces === null && event.preventDefault());
addEventListener("keydown", (event) => {
  const typing = document.activeElement === $("label");
  if (event.key === "Escape") return typing ? $("label").blur() : $("clear").onclick();
  if (event.key === "Enter" && (typing || document.activeElement === document.body)) return guarded(confirmThing);
  if (typing || ((event.ctrlKey || event.metaKey || event.altKey) && event.key !== "z")) return;
  const keys = {
    z: () => view.clicks.length && guarded(undo),
    l: () => $("label").focus(),
    f: () => guarded(finish),
    ArrowLeft: () => guarded(() => choose(view.chosen - 1)),
    ArrowRight: () => guarded(() => choose(view.chosen + 1)),
    Delete: () => view.replaces !== null && guarded(() => remove(view.replaces)),
  };
  const act = keys[event.key];
  if (act) {
    event.preventDefault();
    act();
  }
});

guarded(load);
