#!/usr/bin/python3
"""Whether the search of the site finds the page that answers a question, among its first three.

  tests/guide/search.py SITE    asks search.js by node; exits 77 where node is not installed
"""

import json
import pathlib
import shutil
import subprocess
import sys

# What people ask, and the pages that answer it.
QUESTIONS = {
    "continue a run": ["guide/checkpoints"],
    "how do I cite": ["guide/citing"],
    "coordination number": ["guide/measure"],
    "D50": ["guide/sieve"],
    "bulk density": ["guide/settle"],
    "cone": ["guide/part", "guide/scene"],
    "annulus": ["guide/part", "guide/scene"],
    "as many as possible": ["guide/part"],
    "contact network": ["guide/measure"],
    "exit codes": ["guide/commands"],
    "install on Debian": ["project/readme"],
    "find_package": ["guide/library"],
}

SCRIPT = """
globalThis.window = globalThis;
require(process.argv[1] + "/search-index.js");
require(process.argv[1] + "/search.js");
console.log(JSON.stringify(JSON.parse(process.argv[2]).map((question) => bernalSearch(question).map((answer) => answer.url))));
"""


def pages_of(urls):
    """In the order in which they are found, without their sections."""
    return list(dict.fromkeys(url.partition(".html")[0] for url in urls))


def problems_of(answers):
    """`answers`: of each question the addresses that are found."""
    for (question, wanted), urls in zip(QUESTIONS.items(), answers, strict=True):
        first = pages_of(urls)[:3]
        if not set(wanted) & set(first):
            yield f"\"{question}\" finds {', '.join(first) or 'nothing'}, not {' or '.join(wanted)}"


def main():
    node = shutil.which("node") or shutil.which("nodejs")
    if not node:
        sys.exit(print("skipped: install nodejs") or 77)
    site = pathlib.Path(sys.argv[1]).resolve()
    done = subprocess.run([node, "-e", SCRIPT, str(site), json.dumps(list(QUESTIONS))], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    problems = list(problems_of(json.loads(done.stdout)))
    print("\n".join(problems) or f"{len(QUESTIONS)} questions find their pages")
    sys.exit(bool(problems))


if __name__ == "__main__":
    main()
