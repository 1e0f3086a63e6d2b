"""The Python reference: what the type stubs declare, with their docstrings."""

import ast
import html
import pathlib
import re

from cpp_reference import inline


def find(command):
    """The stubs of the module; nothing where there are none."""
    found = sorted(pathlib.Path(command).resolve().parent.glob("python/bernal/*.pyi"))
    return found or None


def parameters(lines):
    """Of a section of a docstring: "name : type", and below it, indented, what that is."""
    parts = []
    for line in lines:
        if line.startswith(" ") and parts:
            parts[-1][1].append(line.strip())
        elif line.strip():
            parts.append((line.strip(), []))
    rows = "".join(f"<dt><code>{html.escape(name, quote=False)}</code></dt><dd>{inline(' '.join(text))}</dd>"
                   for name, text in parts)
    return f"<dl>{rows}</dl>"


def docs(text):
    """A docstring as HTML: paragraphs, sections of parameters, and what is indented as it stands."""
    parts = []
    for paragraph in re.split(r"\n\s*\n", (text or "").strip()):
        lines = paragraph.split("\n")
        if len(lines) > 1 and re.fullmatch(r"-{3,}", lines[1].strip()):
            parts.append(f"<h4>{html.escape(lines[0])}</h4>" + parameters(lines[2:]))
        elif paragraph and all(line.startswith("    ") or line.startswith(">>>") for line in lines):
            parts.append("<pre><code>" + html.escape("\n".join(line[4:] for line in lines), quote=False) + "</code></pre>")
        elif paragraph:
            parts.append("<p>" + inline(" ".join(line.strip() for line in lines)) + "</p>")
    return "\n".join(parts)


def signature(node):
    return f"{node.name}({ast.unparse(node.args)})" + (f" -> {ast.unparse(node.returns)}" if node.returns else "")


def is_property(node):
    return any(isinstance(d, ast.Name) and d.id == "property" for d in node.decorator_list)


def members(node):
    rows = []
    for item in node.body:
        if isinstance(item, ast.FunctionDef) and (not item.name.startswith("_") or item.name == "__init__"):
            shown = f"{item.name}: {ast.unparse(item.returns)}" if is_property(item) and item.returns else signature(item)
            rows.append(f"<dt><code>{html.escape(shown, quote=False)}</code></dt><dd>{docs(ast.get_docstring(item))}</dd>")
        if isinstance(item, ast.AnnAssign):
            rows.append(f"<dt><code>{html.escape(ast.unparse(item), quote=False)}</code></dt><dd></dd>")
    return f"<dl>{''.join(rows)}</dl>" if rows else ""


def page_of(files):
    parts, used = ["<h1>Python module</h1>"], set()
    for file in files:
        tree = ast.parse(file.read_text())
        parts.append(docs(ast.get_docstring(tree)))
        for node in tree.body:
            if not isinstance(node, (ast.ClassDef, ast.FunctionDef)) or node.name.startswith("_"):
                continue
            name = node.name
            place = f' id="{name}"' if name not in used else ""
            used.add(name)
            parts.append(f"<h3{place}>{name}</h3>")
            if isinstance(node, ast.FunctionDef):
                parts.append(f"<pre><code>{html.escape(signature(node), quote=False)}</code></pre>")
            parts.append(docs(ast.get_docstring(node)))
            if isinstance(node, ast.ClassDef):
                parts.append(members(node))
    return "\n".join(parts)
