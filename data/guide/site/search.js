// Search from disk: the index comes as a script when it is first asked for, because pages from disk may not fetch.
// `bernalSearch(question)` needs no page, so that a test can ask it.
(() => {
  const plain = (text) => text.toLowerCase().normalize("NFKD").replace(/[\u0300-\u036f]/g, "");
  const wordsOf = (text) => plain(text).match(/[\p{L}\p{N}]+/gu) ?? [];
  const silent = new Set(("a an and are as at be by can do does for from get has have how i in is it make my of on or so that the " +
    "there this to want was what when where which who why with").split(" "));
  /** "packings", "packing" and "packed" are one word, and so are "cite" and "citing". */
  const stem = (word) => {
    for (const end of ["ations", "ation", "ings", "ing", "ed", "es", "s", "e"])
      if (word.length - end.length >= 3 && word.endsWith(end)) return word.slice(0, word.length - end.length);
    return word;
  };

  let sections = null, holding = null;  // of a stem: how many sections hold it
  function prepare() {
    holding = new Map();
    sections = window.bernalPages.map(([url, title, heading, text]) => {
      const all = wordsOf(`${heading} ${text}`), counts = new Map();
      for (const word of all.map(stem)) counts.set(word, (counts.get(word) ?? 0) + 1);
      for (const word of counts.keys()) holding.set(word, (holding.get(word) ?? 0) + 1);
      return { url, title, heading, text, counts, length: all.length, running: ` ${all.map(stem).join(" ")} `,
               heads: new Set(wordsOf(heading).map(stem)), titles: new Set(wordsOf(title).map(stem)) };
    });
  }

  /** How well sections answer: words that few sections hold count most, those in headings more, and most the words as
      they were asked, one after the other. The last word may be the beginning of one, since it is still being typed. */
  function search(question) {
    if (!sections) prepare();
    const asked = wordsOf(question), spoken = asked.filter((word) => !silent.has(word));
    const words = (spoken.length > 0 ? spoken : asked).map((word, index, all) => {
      const known = holding.has(stem(word));
      return { stem: stem(word), begins: !known && index === all.length - 1 ? word : null };
    });
    if (words.length === 0) return [];
    const phrase = ` ${asked.map(stem).join(" ")} `, core = ` ${words.map((word) => word.stem).join(" ")} `;
    const answers = [];
    for (const section of sections) {
      let score = 0, found = 0;
      for (const word of words) {
        const is = word.begins ? (other) => other.startsWith(word.begins) : (other) => other === word.stem;
        const has = (set) => word.begins ? [...set].some(is) : set.has(word.stem);
        let count = section.counts.get(word.stem) ?? 0;
        if (word.begins) for (const [other, times] of section.counts) if (is(other)) count += times;
        const rare = Math.log(1 + sections.length / (1 + (holding.get(word.stem) ?? 0)));
        const often = count * 2.2 / (count + 1.2 * (0.4 + 0.6 * section.length / 150));
        const here = often + (has(section.heads) ? 2.5 : 0) + (has(section.titles) ? 1 : 0);
        score += rare * here;
        if (here > 0) found += 1;
      }
      if (found === 0) continue;
      if (words.length > 1 && (section.running.includes(phrase) || section.running.includes(core))) score *= 2;
      if (section.url.startsWith("guide/")) score *= 1.5;
      answers.push({ ...section, score: score * (found / words.length) ** 2, whole: found === words.length });
    }
    const whole = answers.filter((answer) => answer.whole);
    return (whole.length > 0 ? whole : answers).sort((a, b) => b.score - a.score).slice(0, 12);
  }
  globalThis.bernalSearch = search;
  if (!globalThis.document) return;

  const box = document.getElementById("search"), found = document.getElementById("found"), root = document.body.dataset.root;
  let loading = false;

  function load() {
    if (loading) return;
    loading = true;
    const script = document.createElement("script");
    script.src = root + "search-index.js";
    script.onload = show;
    document.head.append(script);
  }

  function link({ url, title, heading, text }, words) {
    const a = document.createElement("a"), small = document.createElement("small");
    a.href = root + url;
    a.textContent = heading === title ? title : `${title}: ${heading}`;
    const places = words.map((word) => plain(text).indexOf(word)).filter((place) => place >= 0);
    const at = Math.max(0, Math.min(...places, text.length) - 40);
    small.textContent = (at > 0 ? "… " : "") + text.slice(at, at + 140);
    a.append(small);
    return a;
  }

  function show() {
    found.replaceChildren();
    if (!window.bernalPages || wordsOf(box.value).length === 0) return;
    const words = wordsOf(box.value).filter((word) => !silent.has(word));
    const all = search(box.value);
    for (const answer of all) found.append(link(answer, words));
    if (all.length === 0) {
      const none = document.createElement("p");
      none.textContent = "No page holds any of these words.";
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
