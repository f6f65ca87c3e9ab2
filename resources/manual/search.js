// Search over all pages of the manual, opened from a disk as well as from a server.
//
// A page opened from a disk may not read its neighbours, but a page in a frame may tell its parent
// what is in it: the contents page loads the others into hidden frames when they are first searched.
"use strict";

const normal = (text) => text.normalize("NFKC").toLowerCase();

/** The text of a part of a page, cells and items set apart. */
function wordsOf(part) {
  const pieces = part.querySelectorAll("tr > *, :scope > li");
  return pieces.length ? [...pieces].map((piece) => piece.textContent).join(" ") : part.textContent;
}

/** What a page holds: for each heading its id, its words and the words below it. */
function sectionsOfThisPage() {
  const sections = [];
  for (const part of document.querySelectorAll("main > *")) {
    const isHeading = /^H[1-3]$/.test(part.tagName);
    if (isHeading) sections.push({ id: part.id, heading: part.textContent, text: "" });
    else if (sections.length) sections[sections.length - 1].text += wordsOf(part) + " ";
  }
  const path = location.pathname.split("/").pop();
  return sections.map((section) => ({ ...section, page: path, title: sections[0].heading }));
}

/** Sections in which all words stand, those with a word in the heading first. */
function found(sections, wanted) {
  const words = normal(wanted).split(/\s+/).filter(Boolean);
  if (!words.length) return [];
  const rank = (section) => (words.some((word) => normal(section.heading).includes(word)) ? 0 : 1);
  return sections
    .filter((section) => {
      const all = normal(section.heading + " " + section.text);
      return words.every((word) => all.includes(word));
    })
    .sort((one, other) => rank(one) - rank(other));
}

/** The words around the first one that was looked for. */
function excerpt(section, wanted) {
  const text = section.text.replace(/\s+/g, " ").trim();
  const word = normal(wanted).split(/\s+/).filter(Boolean)[0];
  const start = Math.max(normal(text).indexOf(word) - 40, 0);
  return (start ? "… " : "") + text.slice(start, start + 120) + (start + 120 < text.length ? " …" : "");
}

function itemOf(section, wanted) {
  const item = document.createElement("li");
  const link = document.createElement("a");
  link.href = section.page + (section.id ? "#" + section.id : "");
  link.textContent =
    section.heading === section.title ? section.title : section.title + " ▸ " + section.heading;
  const words = document.createElement("p");
  words.textContent = excerpt(section, wanted);
  item.append(link, words);
  return item;
}

function searchHere(form) {
  const field = form.querySelector("input");
  const list = document.getElementById("found");
  const frames = [];
  const sections = new Map();

  function show() {
    const hits = found(frames.flatMap((frame) => sections.get(frame) ?? []), field.value);
    list.replaceChildren(...hits.map((section) => itemOf(section, field.value)));
    list.hidden = !field.value.trim();
    if (!hits.length && sections.size === frames.length) {
      const nothing = document.createElement("li");
      nothing.textContent = list.dataset.nothing;
      list.append(nothing);
    }
  }

  function load() {
    if (frames.length) return;
    for (const link of document.querySelectorAll("dt a")) {
      const frame = document.createElement("iframe");
      frame.hidden = true;
      frame.src = link.getAttribute("href");
      frames.push(frame);
      document.body.append(frame);
    }
  }

  window.addEventListener("message", (event) => {
    const sender = frames.find((frame) => frame.contentWindow === event.source);
    if (!sender || !Array.isArray(event.data)) return;
    sections.set(sender, event.data);
    show();
  });
  field.addEventListener("input", () => {
    load();
    show();
  });
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const first = list.querySelector("a");
    if (first) location.href = first.href;
  });
  form.hidden = false;
}

if (window.parent !== window) {
  window.parent.postMessage(sectionsOfThisPage(), "*");
} else {
  const form = document.querySelector("form[role=search]");
  if (form) searchHere(form);
}
