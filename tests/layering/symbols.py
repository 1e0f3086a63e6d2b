#!/usr/bin/python3
"""Whether rooms call only what the table in src/README.md lets them include, by the symbols of the object files: a
function that one room declares and another defines is seen by no include."""

import collections
import functools
import pathlib
import re
import subprocess
import sys

SOURCE, BUILD = map(pathlib.Path, sys.argv[1:3])


README = (SOURCE / "src/README.md").read_text()
# "`stage_tables` (`scene/`, in `plan/`)": declared in the first room, defined in the second.
DECLARED_ABOVE = set(re.findall(r"`(\w+)` \(`(\w+)/`, in `(\w+)/`\)", README))


def rules():
    """For each room of the table the rooms that it may use, if only by some of their files."""
    allowed = {}
    for line in README.splitlines():
        row = re.match(r"\|[^|`]*\| `(\w+)/` \|.*\| ([^|]+) \|$", line)
        if row and row[2] == "what stands above":
            allowed[row[1]] = set(allowed)
        elif row and row[2] in ("nothing", "public headers"):
            allowed[row[1]] = set()
        elif row:
            allowed[row[1]] = {part.split()[0] for part in row[2].split(",")}
    return allowed


@functools.cache
def members_of(library):
    return subprocess.check_output(["ar", "t", library], text=True).split() if library.exists() else []


def is_linked(object_file):
    """Whether an object is in its library: a build folder keeps objects of files that have moved."""
    name = object_file.relative_to(BUILD / "src/CMakeFiles").parts[0].removesuffix(".dir").removesuffix("_cold")
    return object_file.name in members_of(BUILD / f"src/lib{name}.a")


def room_of(object_file):
    """The folder below src that it was compiled from: alone, or together with others of the folder."""
    if object_file.parent.name == "Unity":
        folder = re.match(r"unity_([a-z_]+)_\d", object_file.name)[1]  # "cad_read" is one in the room "cad"
        return folder if (SOURCE / "src" / folder).is_dir() else folder.split("_")[0]
    below = object_file.relative_to(BUILD / "src/CMakeFiles").parts
    return below[1] if len(below) > 2 else None


def main():
    defined, used = {}, collections.defaultdict(set)
    for object_file in sorted(BUILD.glob("src/CMakeFiles/bernal_*.dir/**/*.o")):
        room = is_linked(object_file) and room_of(object_file)
        if not room:
            continue  # not of a library, or of a file that the build makes
        for line in subprocess.check_output(["nm", object_file], text=True).splitlines():
            kind, name = line.split()[-2:]
            if kind in "TDBR":
                defined[name] = room
            elif kind == "U":
                used[room].add(name)
    calls = collections.defaultdict(set)
    for room, names in used.items():
        for name in names & defined.keys():
            function = re.match(r"_ZN6bernal(\d+)", name)  # bernal::function, whatever its arguments
            short = function and name[function.end():][: int(function[1])]
            if defined[name] != room and (short, room, defined[name]) not in DECLARED_ABOVE:
                calls[room, defined[name]].add(name)
    allowed = rules()
    wrong = [(rooms, names) for rooms, names in sorted(calls.items()) if rooms[1] not in allowed.get(rooms[0], ())]
    for (room, other), names in wrong:
        words = subprocess.check_output(["c++filt", *sorted(names)[:3]], text=True).splitlines()
        print(f"{room} must not use {other}: " + ", ".join(word.split("(")[0] for word in words))
    print(f"{len(calls)} pairs of rooms of {len(used)}")
    sys.exit(bool(wrong) or len(calls) < 50)


if __name__ == "__main__":
    main()
