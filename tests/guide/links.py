#!/usr/bin/python3
"""Whether every link in the project's Markdown leads to a file that is there, and to a heading in it; whether the files
exist that the pages for developers and the comments in the code name; whether installed headers name only what whoever
has them alone can find; and whether README and the guide name this version."""

import pathlib
import re
import sys
import urllib.parse

SOURCE = pathlib.Path(sys.argv[1]).resolve()
# A file in a folder, as in `cad/read/zip_archive.hpp`; made files and patterns such as `write_<ext>.cpp` are left out.
NAMED = re.compile(r"(?<![\w/.<>*$-])([a-z_]+(?:/[a-z0-9_.-]+)+\.(?:hpp|cpp|cu|py|cmake|txt|md|json|toml))(?![\w<*])")
LINK = re.compile(r"\]\(([^()\s]+(?:\([^()]*\)[^()\s]*)*)\)")


def prose_of(text):
    """Without blocks of code and code in lines."""
    text = re.sub(r"^```.*?^```$", "", text, flags=re.S | re.M)
    return re.sub(r"`[^`\n]*`", "", text)


def anchors_of(text):
    """Of the headings, as GitHub and pandoc's gfm make them."""
    anchors, counts = set(), {}
    for heading in re.findall(r"^#+ +(.*?) *$", re.sub(r"^```.*?^```$", "", text, flags=re.S | re.M), flags=re.M):
        plain = re.sub(r"<[^>]*>|\[([^\]]*)\]\([^)]*\)|[`*]", lambda m: m[1] or "", heading)
        slug = re.sub(r"[^\w\- ]", "", plain.lower()).replace(" ", "-")
        number = counts.get(slug, 0)
        counts[slug] = number + 1
        anchors.add(slug if number == 0 else f"{slug}-{number}")
    return anchors


def named_files():
    """(Where, file) of each file that a page for developers names in backticks, or a comment in the code."""
    for page in ("CONTRIBUTING.md", "src/README.md"):
        for code in re.findall(r"`([^`\n]*)`", re.sub(r"^```.*?^```$", "", (SOURCE / page).read_text(), flags=re.S | re.M)):
            yield from ((page, name) for name in NAMED.findall(code))
    for folder in ("src", "include", "apps", "tests"):
        for file in sorted((SOURCE / folder).rglob("*.[hc]pp")):
            for number, line in enumerate(file.read_text().splitlines(), 1):
                comment = re.search(r"(?<!:)//.*", line)
                for name in NAMED.findall(comment[0]) if comment else []:
                    yield f"{file.relative_to(SOURCE)}:{number}", name


def strangers_in_headers():
    """(Where, name) of what the comments of installed headers name and those who have only these headers cannot find:
    files of the source, and names in backticks that no such header declares and no scene, report or program has."""
    own = re.search(r"set\(bernal_own_headers\s+([^)]*)\)", (SOURCE / "src/CMakeLists.txt").read_text())[1].split()
    folder = SOURCE / "include/bernal"
    headers = {str(file.relative_to(folder)): file.read_text().splitlines() for file in sorted(folder.rglob("*.hpp"))}
    headers = {name: lines for name, lines in headers.items() if name not in own}
    written = " ".join(line.partition("//")[0] for lines in headers.values() for line in lines)
    known = set(re.findall(r"\w+", written))
    for file in sorted(SOURCE.glob("data/schemas/*.json")):
        known |= set(re.findall(r"\w+", file.read_text()))
    for header, lines in headers.items():
        for number, line in enumerate(lines, 1):
            comment = line.partition("//")[2]
            names = [name for name in NAMED.findall(comment) if name not in headers]
            names += re.findall(r"(?<![\w/])(?:src|tests|data|apps|cmake)/[\w/.-]*\w", comment)
            for code in re.findall(r"`(\w+(?:(?:::|\.)\w+)*)(?:\(\))?`", comment):
                names += [code] if "." not in code and not set(code.split("::")) <= known else []
            yield from ((f"include/bernal/{header}:{number}", name) for name in dict.fromkeys(names))


def other_versions(files):
    """(Where, name) of what README and the guide call by a version that is not that of the source."""
    version = re.search(r"^project\(bernal VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text(), flags=re.M)[1]
    for file in files:
        for name, found in re.findall(r"(bernal[-_ (]+v?(\d+(?:\.\d+)+))", file.read_text()):
            if not (version + ".").startswith(found + "."):
                yield file, name


def is_there(name):
    return any((SOURCE / root / name).exists() for root in ("", "src", "include", "include/bernal", "tests"))


def main():
    files = [SOURCE / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "src/README.md")]
    files += sorted(SOURCE.glob("data/**/*.md"))
    problems, links = [], 0
    for file in files:
        for link in LINK.findall(prose_of(file.read_text())):
            links += 1
            if re.match(r"[a-z]+:", link):
                continue
            path, _, anchor = urllib.parse.unquote(link).partition("#")
            target = (file.parent / path).resolve() if path else file
            if not target.exists() or not target.is_relative_to(SOURCE):
                problems.append(f"{file}: {link} leads nowhere")
            elif anchor and target.suffix == ".md" and anchor not in anchors_of(target.read_text()):
                problems.append(f"{file}: {link}: no heading makes that anchor")
    named = list(named_files())
    problems += [f"{where}: there is no {name}" for where, name in named if not is_there(name) and "build/" not in name]
    problems += [f"{where}: {name} is in no header that is installed" for where, name in strangers_in_headers()]
    pages = [SOURCE / "README.md", *(SOURCE / "data/guide").glob("*.md")]
    problems += [f"{file}: {name} is another version" for file, name in other_versions(pages)]
    print("\n".join(problems) or f"{links} links in {len(files)} files lead somewhere")
    sys.exit(bool(problems) or links < 50 or len(named) < 50)


if __name__ == "__main__":
    main()
