#!/usr/bin/python3
"""Whether CMakeLists.txt, CITATION.cff and CHANGELOG.md name the same version and day of release, whether the changelog
has the form from which a reader finds a release, and whether it tells the packings number that the library has."""

import pathlib
import re
import sys

SOURCE = pathlib.Path(sys.argv[1]).resolve()
RELEASE = re.compile(r"## \[(\d+\.\d+\.\d+)\] - (\d{4}-(?:0[1-9]|1[0-2])-(?:0[1-9]|[12]\d|3[01]))")


def found(file, pattern):
    """The only match in a file; ends the test where there is none, or more than one."""
    matches = re.findall(pattern, (SOURCE / file).read_text(), flags=re.M)
    if len(matches) != 1:
        sys.exit(f"{file}: {len(matches)} lines match {pattern}, and one should")
    return matches[0]


def main():
    problems = []
    version = found("CMakeLists.txt", r"^project\(bernal VERSION (\S+) ")
    headings = [line for line in (SOURCE / "CHANGELOG.md").read_text().splitlines() if line.startswith("## ")]
    if headings[:1] != ["## [Unreleased]"]:
        problems.append("CHANGELOG.md: the first section is not ## [Unreleased]")
    releases = []
    for heading in headings[1:]:
        if match := RELEASE.fullmatch(heading):
            releases.append((match[2], tuple(map(int, match[1].split(".")))))
        else:
            problems.append(f"CHANGELOG.md: {heading}: a release is ## [1.2.3] - 2001-02-03")
    if releases != sorted(set(releases), reverse=True):
        problems.append("CHANGELOG.md: the newest release does not come first")
    newest = RELEASE.fullmatch(headings[1]) if len(headings) > 1 else None
    cited = found("CITATION.cff", r"^version: (\S+)$"), found("CITATION.cff", r"^date-released: (\S+)$")
    if newest is None or newest[1] != version:
        problems.append(f"CHANGELOG.md: the newest release is not {version}, the version in CMakeLists.txt")
    elif cited != newest.groups():
        problems.append(f"CITATION.cff says {' of '.join(cited)}, the changelog {' of '.join(newest.groups())}")
    packings = int(found("src/core/version.cpp", r"^constexpr int packings = (\d+);"))
    told = max(map(int, re.findall(r"[Pp]ackings number (\d+)", (SOURCE / "CHANGELOG.md").read_text())), default=0)
    if told != packings:
        problems.append(f"CHANGELOG.md tells the packings number {told}, and the library has {packings}: say what changed "
                        "packings under [Unreleased]")
    print("\n".join(problems) or f"version {version} of {newest[2]}, packings number {packings}")
    sys.exit(bool(problems))


if __name__ == "__main__":
    main()
