"""The C++ reference: every public header as a page, its comments as prose and its declarations as code."""

import html
import re

KEYWORDS = ("alignas auto bool break case catch class concept const constexpr consteval continue default delete do double "
            "else enum explicit extern false final float for friend if inline int mutable namespace new noexcept nullptr "
            "operator override private protected public requires return short signed sizeof static static_assert struct "
            "switch template this throw true try typedef typename union unsigned using virtual void volatile while").split()
TOKEN = re.compile(r"(?P<co>//[^\n]*)|(?P<st>\"(?:[^\"\\\n]|\\.)*\"|'(?:[^'\\\n]|\\.)+')|(?P<dv>\b\d[\w.+']*)|(?P<kw>\b(?:"
                   + "|".join(KEYWORDS) + r")\b)|(?P<pp>^#[^\n]*)", re.M)
NAMED = re.compile(r"\b(?:struct|class|enum class|enum|concept|namespace)\s+(\w+)|\busing\s+(\w+)\s*=|\b(\w+)\s*\(|"
                   r"\b(\w+)\s*(?:=|\{|;|\[)")


def highlighted(code):
    parts, end = [], 0
    for token in TOKEN.finditer(code):
        parts.append(html.escape(code[end:token.start()], quote=False))
        parts.append(f'<span class="{token.lastgroup}">{html.escape(token[0], quote=False)}</span>')
        end = token.end()
    return "".join(parts) + html.escape(code[end:], quote=False)


def inline(text):
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", html.escape(text, quote=False))


def prose(lines):
    """Paragraphs; indented lines are equations."""
    parts, paragraph, formula = [], [], []

    def close():
        if paragraph:
            parts.append(f"<p>{inline(' '.join(paragraph))}</p>")
        if formula:
            parts.append("<pre><code>" + html.escape("\n".join(formula), quote=False) + "</code></pre>")
        paragraph.clear()
        formula.clear()

    for line in lines:
        if not line.strip():
            close()
        elif line.startswith("  ") and not line.strip().startswith("- "):
            if paragraph:
                close()
            formula.append(line.strip())
        else:
            if formula:
                close()
            paragraph.append(line.strip())
    close()
    return "\n".join(parts)


def chunks_of(text):
    """Of what stands at the top of the namespace: its comment and its code."""
    comment, code, chunks = [], [], []
    depth = 0

    def close():
        nonlocal comment, code
        while code and not code[-1].strip():
            code.pop()
        if comment or code:
            chunks.append((comment, code))
        comment, code = [], []

    for line in text.split("\n"):
        if depth == 0 and re.match(r"#pragma once|#include|namespace bernal(::\w+)? \{$|\}  // namespace", line):
            continue
        if depth == 0 and line.startswith("//") and not code:
            comment.append(re.sub(r"^///? ?", "", line))
            continue
        if depth == 0 and line.startswith("///"):
            close()
            comment.append(line[4:])
            continue
        if depth == 0 and not line.strip():
            close()
            continue
        code.append(line)
        bare = re.sub(r"//.*|\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)'", "", line)
        depth += sum(bare.count(c) for c in "{(") - sum(bare.count(c) for c in "})")
    close()
    return chunks


def name_of(code):
    text = re.sub(r"//[^\n]*", "", "\n".join(code))
    text = re.sub(r"^\s*template <[^\n]*>\s*", "", text)
    found = NAMED.search(text)
    return next((name for name in found.groups() if name), None) if found else None


def page_of(header, path):
    """HTML of a header; `path` is how it is included."""
    parts = [f"<h1>{html.escape(path)}</h1>",
             f'<pre><code><span class="pp">#include &lt;bernal/{html.escape(path)}&gt;</span></code></pre>']
    used = set()
    for comment, code in chunks_of(header.read_text()):
        name = name_of(code) if code else None
        if name and name not in used:
            used.add(name)
            parts.append(f'<h3 id="{html.escape(name)}">{html.escape(name)}</h3>')
        parts.append(prose(comment))
        if code:
            parts.append("<pre><code>" + highlighted("\n".join(code)) + "</code></pre>")
    return "\n".join(parts)


def first_sentence(header):
    """What the first thing that it declares is."""
    for comment, _ in chunks_of(header.read_text()):
        text = " ".join(line.strip() for line in comment)
        if text:
            return re.split(r"(?<=[.:;])\s", text, maxsplit=1)[0].rstrip(".:;")
    return ""
