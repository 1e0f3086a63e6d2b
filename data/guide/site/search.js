// Search from disk: the index comes as a script when it is first asked for, because pages from disk may not fetch.
(() => {
  const box = document.getElementById("search"), found = document.getElementById("found"), root = document.body.dataset.root;
  const plain = (text) => text.toLowerCase().normalize("NFKD").replace(/[\u0300-\u036f]/g, "");
  let loading = false;

  function load() {
    if (loading) return;
    loading = true;
    const script = document.createElement("script");
    script.src = root + "search-index.js";
    script.onload = show;
    document.head.append(script);
  }

  /** The sections that hold all words, those first that name them. */
  function matches(words) {
    const all = [];
    for (const [url, title, heading, text] of window.bernalPages) {
      const name = plain(heading), page = plain(title), body = plain(text);
      let score = 0;
      for (const word of words) {
        const rank = (name === word ? 60 : 0) + (name.includes(word) ? 20 : 0) + (page.includes(word) ? 6 : 0) + (body.includes(word) ? 1 : 0);
        score = rank === 0 ? -Infinity : score + rank;
      }
      if (score > 0) all.push({ score: score + (url.startsWith("guide/") ? 3 : 0), url, title, heading, text });
    }
    return all.sort((a, b) => b.score - a.score).slice(0, 12);
  }

  function link({ url, title, heading, text }, word) {
    const a = document.createElement("a"), small = document.createElement("small");
    a.href = root + url;
    a.textContent = heading === title ? title : `${title}: ${heading}`;
    const at = Math.max(0, plain(text).indexOf(word) - 40);
    small.textContent = (at > 0 ? "… " : "") + text.slice(at, at + 140);
    a.append(small);
    return a;
  }

  function show() {
    const words = plain(box.value).split(/\s+/).filter(Boolean);
    found.replaceChildren();
    if (words.length === 0 || !window.bernalPages) return;
    const all = matches(words);
    for (const match of all) found.append(link(match, words[0]));
    if (all.length === 0) {
      const none = document.createElement("p");
      none.textContent = "Nothing holds all of these words.";
      found.append(none);
    }
  }

  box.addEventListener("focus", load);
  box.addEventListener("input", () => { load(); show(); });
  document.addEventListener("keydown", (event) => {
    if (event.key === "/" && !/INPUT|TEXTAREA/.test(document.activeElement.tagName)) { event.preventDefault(); box.focus(); }
    if (event.key === "Escape" && document.activeElement === box) { box.value = ""; show(); box.blur(); }
  });
})();
