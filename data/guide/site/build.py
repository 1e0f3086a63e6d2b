#!/usr/bin/python3
"""Makes the site: HTML of the guide, of what the command says of itself, of the headers and of the results.

  data/guide/site/build.py COMMAND SOURCE OUT

Pages are Markdown, turned by pandoc, or HTML that is made here. Links between files of the source become links between
pages; what is no page is copied below files/. Everything is relative and nothing comes from elsewhere, so that the site
can be read from disk. Ends with 1 if a link of a page leads to no file of the source, or a page is in no section;
check.py looks at what is made.
"""

import html
import json
import pathlib
import re
import shutil
import string
import subprocess
import sys
import urllib.parse
from concurrent.futures import ThreadPoolExecutor

import cpp_reference
import python_reference
import tables

COMMAND, SOURCE, OUT = sys.argv[1], pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3]).resolve()
HERE = pathlib.Path(__file__).resolve().parent
ICON = (HERE / "icon.svg").read_text().strip()

# In the order of the navigation: sections, and of each page its address, where it comes from and its name there.
SECTIONS = [
    ("Guide", [(f"guide/{name}", f"data/guide/{name}.md", title) for name, title in (
        ("part", "Fill a CAD part"), ("repair", "Repair a CAD file"), ("sieve", "Match a sieve curve"),
        ("periodic", "A dense periodic box"), ("mesh", "Mesh a packing"), ("hand_over", "Hand over to LAMMPS"),
        ("engines", "Engines on many machines"),
        ("density", "How dense can it be"), ("settle", "Settle a bed"), ("measure", "Look and measure"),
        ("layers", "Layers of spheres"), ("nests", "Packings in spheres"), ("cells", "Cells: grains and foams"),
        ("cost", "Accuracy, time and cost"), ("sweep", "Many scenes at once"),
        ("checkpoints", "Runs that are ended and go on"),
        ("python", "From Python"))]),
    ("To know more", [(f"guide/{name}", f"data/guide/{name}.md", title) for name, title in (
        ("commands", "Commands and exit codes"), ("scene", "The scene file"),
        ("certificate", "What the certificate means"), ("files", "The files of a result"),
        ("formats", "Formats of other programs"), ("import", "From other programs"),
        ("exchange", "Exchange of sizes"), ("wide_sizes", "Wide sizes"), ("library", "As a C++ library"),
        ("citing", "How to cite, and sources"))]),
    ("Reference", [("reference/scene", None, "Every key of a scene"), ("reference/commands", None, "Every command"),
                   ("reference/report", None, "report.json and --json"), ("reference/cpp", None, "C++ headers"),
                   ("reference/python", None, "Python module"), ("reference/scenes", None, "Example scenes")]),
    ("Results", [("results/reaches", "data/guide/reaches.md", "What it reaches")] +
     [(f"results/{name}", f"data/results/{name}.md", title) for name, title in (
         ("methods", "What each method costs"), ("effects", "Effects, one by one"), ("arithmetic", "What each level of arithmetic costs"),
         ("exchange", "Exchange of sizes"), ("loose", "Loose packings"), ("beds", "Beds in columns"), ("column", "A closed column"), ("poured", "Beds with friction"),
         ("containers", "Many spheres in CAD parts"),
         ("large", "Large packings"), ("lists", "Lists and arrays"),
         ("engines", "Engines over MPI"), ("scale", "How relaxation scales"), ("gpu", "Relaxation on a GPU"), ("packers", "Against public packers"),
         ("records", "Few spheres against records"), ("hard", "Hard cases"), ("starts", "Packings of others"), ("earlier", "Earlier measurements"))] +
     [(f"results/{name}", f"data/results/papers/{name}/{name}.md", title) for name, title in (
         ("zhao2007", "Zhao et al. 2007"), ("han2005", "Han et al. 2005"), ("farr2013", "Farr 2013"))] +
     [("results/validation", "data/results/validation.md", "Against the published world"),
      ("results/timings", "data/results/timings.md", "All timings"),
      ("results/relaxation", "data/results/relaxation.md", "Relaxation against the paper"),
      ("results/estimates", "data/results/estimates.md", "Estimates of explain"),
      ("results/meshes", "data/results/meshes.md", "Meshes of beds")]),
    ("The project", [("project/readme", "README.md", "README"), ("project/map", "src/README.md", "The map of the code"),
                     ("project/contributing", "CONTRIBUTING.md", "Working on bernal"),
                     ("project/changelog", "CHANGELOG.md", "Changelog"),
                     ("project/meshes", "data/meshes/README.md", "Example meshes")])]


def pandoc(markdown):
    return subprocess.run(["pandoc", "--from=gfm+attributes", "--to=html5", "--wrap=none"], input=markdown,
                          capture_output=True, text=True, check=True).stdout


OURS = re.compile(r"(`[^`\n]*`)|<(?!/?(?:sub|sup|ul|li|a|b|span)\b|!--)(?=[A-Za-z/])")


def without_strange_tags(text):
    """Names such as calendar<heap> are no HTML."""
    parts = re.split(r"(^```.*?^```$)", text, flags=re.M | re.S)
    return "".join(p if p.startswith("```") else OURS.sub(lambda m: m[1] or "&lt;", p) for p in parts)


def html_of_markdown(text):
    """A fence's words after the language are for the test that runs it."""
    text = without_strange_tags(text)
    text = re.sub(r"^```(\w+) .*$", r"```\1", text, flags=re.M)
    text = re.sub(r"^<!-- picture: .* -->\n", "", text, flags=re.M)
    body = pandoc(text)
    body = re.sub(r"<table>.*?</table>", lambda m: f'<div class="wide">{m[0]}</div>', body, flags=re.S)
    body = re.sub(r"<colgroup>.*?</colgroup>", "", body, flags=re.S)
    body = body.replace(' style="text-align: right;"', ' class="number"')
    body = re.sub(r' style="[^"]*"', "", body)
    body = re.sub(r'(?<=<td class="number">).*?(?=</td>)', lambda m: re.sub(r"(?<=\d) (?=[a-zµ]+\b)", "\u00a0", m[0]), body)
    return re.sub(r"<table>.*?</table>", lambda m: tables.stacked(m[0]), body, flags=re.S)


class Site:
    def __init__(self):
        self.pages = {}    # address: (title, body, source)
        self.of_file = {}  # file of the source: address
        self.copied = set()
        self.problems = []

    def look_for_forgotten_pages(self):
        """A page of the guide or of the results that no section names would be reached by nobody."""
        for folder in ("data/guide", "data/results"):
            for file in sorted((SOURCE / folder).glob("*.md")):
                if (name := str(file.relative_to(SOURCE))) not in self.of_file:
                    self.problems.append(f"{name} is in none of SECTIONS, in data/guide/site/build.py")

    def link(self, link, source, address):
        """Where a link of a file of the source leads to from a page."""
        if re.match(r"[a-z]+:|#|$", link):
            return link
        path, _, anchor = link.partition("#")
        target = ((SOURCE / source).parent / urllib.parse.unquote(path)).resolve()
        if not target.exists() or not target.is_relative_to(SOURCE):
            self.problems.append(f"{source}: {link} leads nowhere")
            return link
        name = str(target.relative_to(SOURCE))
        up = "../" * address.count("/")
        if target.is_dir():
            return {"data/scenes": up + "reference/scenes.html"}.get(name, up + "index.html")
        if name in self.of_file:
            return up + self.of_file[name] + ".html" + (f"#{anchor}" if anchor else "")
        self.copied.add(name)
        return up + "files/" + urllib.parse.quote(name)

    def with_links(self, body, source, address):
        """Links of the source as those of the site; headers that are named as they are included become links too."""
        body = re.sub(r'(<(?:a|img)\b[^>]*?\b(?:href|src))="([^"]*)"',
                      lambda m: f'{m[1]}="{html.escape(self.link(html.unescape(m[2]), source, address))}"', body)
        up = "../" * address.count("/")
        return re.sub(r"<code>&lt;(bernal/\w+/\w+\.hpp)&gt;</code>",
                      lambda m: f'<a href="{up}{self.of_file[f"include/{m[1]}"]}.html">{m[0]}</a>', body)

    def add(self, address, title, body, source="README.md"):
        self.pages[address] = (title, self.with_links(body, source, address), source)

    def navigation(self, current, body):
        up = "../" * current.count("/")
        parts = []
        for section, pages in SECTIONS:
            parts.append(f"<h2>{section}</h2>\n<ul>")
            for address, _, title in pages:
                if address not in self.pages:
                    continue
                here = ' aria-current="page"' if address == current else ""
                parts.append(f'<li><a href="{up}{address}.html"{here}>{html.escape(title)}</a>')
                heads = re.findall(r'<h2 id="([^"]+)">(.*?)</h2>', body) if here else []
                if 1 < len(heads) < 30:
                    parts.append("<ul>" + "".join(f'<li><a href="#{i}">{re.sub("<[^>]+>", "", t)}</a></li>' for i, t in heads)
                                 + "</ul>")
                parts.append("</li>")
            parts.append("</ul>")
        return "\n".join(parts)

    def footer(self, current):
        """To the pages before and after it in its section."""
        up = "../" * current.count("/")
        for _, pages in SECTIONS:
            there = [(a, t) for a, _, t in pages if a in self.pages]
            for index, (address, _) in enumerate(there):
                if address != current:
                    continue
                before = f'<a href="{up}{there[index - 1][0]}.html">← {html.escape(there[index - 1][1])}</a>' if index else ""
                after = (f'<a href="{up}{there[index + 1][0]}.html">{html.escape(there[index + 1][1])} →</a>'
                         if index + 1 < len(there) else "")
                return f"<span>{before}</span><span>{after}</span>"
        return f'<span><a href="{up}index.html">bernal</a></span>'

    def write(self):
        template = string.Template((HERE / "page.html").read_text())
        for address, (title, body, _) in self.pages.items():
            shown = re.sub(r'<(h[23]) id="([^"]+)">(.*?)</\1>',
                           r'<\1 id="\2">\3<a class="here" href="#\2" aria-label="Link to this section">#</a></\1>', body)
            file = OUT / f"{address}.html"
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(template.substitute(
                title=html.escape(title), root="../" * address.count("/"), icon=ICON, body=shown,
                navigation=self.navigation(address, body), footer=self.footer(address)))
        for name in sorted(self.copied):
            (OUT / "files" / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(SOURCE / name, OUT / "files" / name)
        for name in ("style.css", "search.js", "icon.svg"):
            shutil.copy(HERE / name, OUT / name)
        (OUT / "search-index.js").write_text(
            "window.bernalPages = " + json.dumps(self.search_index(), ensure_ascii=False, separators=(",", ":")) + ";\n")

    def search_index(self):
        """Of every section its page, heading and text."""
        index = []
        for address, (title, body, _) in self.pages.items():
            parts = re.split(r'(<h[23] id="[^"]+">.*?</h[23]>)', body, flags=re.S)
            anchor, heading = "", title
            for part in parts:
                head = re.fullmatch(r'<h[23] id="([^"]+)">(.*?)</h[23]>', part, flags=re.S)
                if head:
                    anchor, heading = "#" + head[1], html.unescape(re.sub("<[^>]+>", "", head[2]))
                    continue
                text = " ".join(html.unescape(re.sub("<[^>]+>", " ", part)).split())
                if text or anchor:
                    index.append([f"{address}.html{anchor}", title, heading, text])
        return index


def example_scenes():
    parts = ["<h1>Example scenes</h1>", "<p>Each is packed, certified and held against its twin on other numbers of threads by "
             "the tests. They stand in <code>data/scenes</code>.</p>"]
    files = sorted((SOURCE / "data/scenes").glob("*.toml"))
    coloured = pandoc("\n\n".join(f"## {f.stem}\n\n```toml\n{f.read_text().strip()}\n```" for f in files))
    return "\n".join(parts) + coloured


def cpp_pages(site):
    folder = SOURCE / "include/bernal"
    headers = sorted(folder.glob("*/*.hpp"))
    rooms = {}
    for header in headers:
        path = str(header.relative_to(folder))
        address = "reference/cpp/" + path.removesuffix(".hpp").replace("/", "_")
        site.of_file[f"include/bernal/{path}"] = address
        rooms.setdefault(header.parent.name, []).append((path, address, cpp_reference.first_sentence(header)))
        site.pages[address] = (path, cpp_reference.page_of(header, path), "src/README.md")
    parts = ["<h1>C++ headers</h1>", "<p>What a program that links <code>bernal::bernal</code> includes; "
             "<code>&lt;bernal/bernal.hpp&gt;</code> is all of it. Radii are radii here, lengths are in the scene's unit, and "
             'bad input throws <code>bernal::Error</code>. A first program is in <a href="../guide/library.html">As a C++ '
             "library</a>.</p>"]
    for room, pages in rooms.items():
        rows = [[tables.cell(f'<a href="cpp/{a.rsplit("/", 1)[1]}.html">{html.escape(p)}</a>'),
                 tables.cell(cpp_reference.inline(what), "what")] for p, a, what in pages]
        parts.append(f'<h2 id="{room}">{room}</h2>' + tables.table(["header", "what"], rows))
    site.pages["reference/cpp"] = ("C++ headers", "\n".join(parts), "src/README.md")


def front_page(site):
    """The index: what the page data/guide/index.md says, and the guide as cards."""
    site.add("index", "bernal", html_of_markdown((SOURCE / "data/guide/index.md").read_text()), "data/guide/index.md")


def main():
    shutil.rmtree(OUT, ignore_errors=True)
    OUT.mkdir(parents=True)
    site = Site()
    written = [(address, source, title) for _, pages in SECTIONS for address, source, title in pages if source]
    site.of_file = {source: address for address, source, _ in written} | {"data/guide/index.md": "index"}
    for header in (SOURCE / "include/bernal").glob("*/*.hpp"):
        path = str(header.relative_to(SOURCE / "include/bernal"))
        site.of_file[f"include/bernal/{path}"] = "reference/cpp/" + path.removesuffix(".hpp").replace("/", "_")
    site.look_for_forgotten_pages()
    with ThreadPoolExecutor() as pool:
        bodies = list(pool.map(lambda page: html_of_markdown((SOURCE / page[1]).read_text()), written))
    for (address, source, title), body in zip(written, bodies):
        site.add(address, title, body, source)
    reference = json.loads(subprocess.run([COMMAND, "keys", "--json"], capture_output=True, check=True).stdout)
    schema = json.loads((SOURCE / "data/schemas/report.schema.json").read_text())
    site.pages["reference/scene"] = ("Every key of a scene", tables.scene_keys(reference), "README.md")
    names = tables.names_of_commands(COMMAND)
    site.pages["reference/commands"] = ("Every command", tables.commands(COMMAND, names), "README.md")
    told = (SOURCE / "data/guide/commands.md").read_text()
    site.problems += [f"data/guide/commands.md does not say what {name} does" for name in names if f"| `{name}` |" not in told]
    site.pages["reference/report"] = ("report.json and --json", tables.report_keys(schema), "README.md")
    site.pages["reference/scenes"] = ("Example scenes", example_scenes(), "README.md")
    cpp_pages(site)
    stub = python_reference.find(COMMAND)
    if stub:
        site.pages["reference/python"] = ("Python module", python_reference.page_of(stub), "README.md")
    front_page(site)
    site.write()
    print("\n".join(site.problems) or f"{len(site.pages)} pages in {OUT}")
    sys.exit(bool(site.problems))


if __name__ == "__main__":
    main()
