"""References that are made from what the command says of itself: keys of scenes, subcommands, report.json."""

import html
import json
import re
import subprocess


def escaped(text):
    return html.escape(str(text), quote=False)


def phrase(text):
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", escaped(text))


def stacked(table, columns=4):
    """A table of words in so many columns or more, so marked that a narrow window shows its cells below each other, each with the
    head of its column; others stay as they are."""
    heads = [html.unescape(re.sub("<[^>]+>", "", head)).strip() for head in re.findall(r"<th\b[^>]*>(.*?)</th>", table, flags=re.S)]
    if len(heads) < columns or 'class="number"' in table:
        return table

    def row(found):
        numbers = iter(range(len(heads)))

        def cell(tag):
            number = next(numbers)
            return tag[0] if number == 0 or not heads[number] else f'<td data-head="{html.escape(heads[number])}"{tag[1]}>'

        return re.sub(r"<td\b([^>]*)>", cell, found[0])

    return re.sub(r"<tr\b.*?</tr>", row, table, flags=re.S).replace("<table>", '<table class="stacked">', 1)


def table(head, rows):
    cells = "".join(f"<th>{escaped(h)}</th>" for h in head)
    body = "\n".join("<tr>" + "".join(row) + "</tr>" for row in rows)
    made = f"<table><thead><tr>{cells}</tr></thead><tbody>\n{body}\n</tbody></table>"
    return f'<div class="wide">{stacked(made, 3)}</div>'


def cell(content, kind=""):
    return f'<td class="{kind}">{content}</td>' if kind else f"<td>{content}</td>"


def said(value):
    return f"<code>{escaped(json.dumps(value, ensure_ascii=False))}</code>" if value is not None else ""


WHERE = {"in_bed": "; between fixed walls", "in_box": "; in periodic boxes"}


def keys_table(part):
    rows = []
    for key in part["keys"]:
        must = "required" if key["required"] and key["default"] is None else said(key["default"])
        help_text = key["help"] + WHERE.get(key["acts"], "")
        rows.append([cell(f"<code>{escaped(key['name'])}</code>"), cell(phrase(help_text), "what"),
                     cell(phrase(key["expectation"])), cell(must)])
    return table(["key", "what", "value", "default"], rows)


def choices_of(part):
    lines = []
    for choice in part["choices"]:
        sets = [" and ".join(f"<code>{k}</code>" for k in one) if one else "none of them" for one in choice]
        lines.append(f"<p>One of: {'; '.join(sets)}.</p>")
    return "\n".join(lines)


def scene_keys(reference):
    """HTML of all that a scene may say."""
    where = {"scene": ("Top of the file, [spheres], [accuracy]", None),
             "container": ("Containers", "[container], chosen by <code>kind</code>"),
             "diameter": ("Sizes", "<code>radius</code> or <code>diameter</code> in [spheres], chosen by "
                          "<code>distribution</code>; a plain length is one size"),
             "engine": ("Engines", "[engine], chosen by <code>kind</code>"),
             "stage": ("Stages", "[[stage]], in the order in which they stand, chosen by <code>do</code>"),
             "output": ("Files for other programs", "[[output]], chosen by <code>format</code>"),
             "zone": ("Zones", "[[zone]], one for each part of the container"),
             "table": ("Tables within tables", "a key of another table, one or an array of them")}
    parts = ["<h1>Every key of a scene</h1>",
             "<p>Made from the table that scenes are read by; in a terminal <code>bernal keys NAME</code> says the same. "
             "Lengths are positive numbers in the scene's <code>unit</code>, from 1e-30 to 1e30 of it. A key that is "
             "not here is an error at its line.</p>"]
    for group in reference["groups"]:
        title, place = where[group["name"]]
        parts.append(f'<h2 id="{group["name"]}s">{title}</h2>')
        if place:
            parts.append(f"<p>In {place}.</p>")
        for part in group["tables"]:
            name = part["name"]
            shown = {"scene": "top of the file", "zone": "[[zone]]"}.get(
                name, f"{{ {name} }}" if group["name"] == "table" else f"[{name}]") if not group["selector"] \
                else f'{group["selector"]} = "{name}"'
            parts.append(f'<h3 id="{group["name"]}-{name}">{escaped(shown)}</h3>')
            parts.append(f"<p>{phrase(part['help'][:1].upper() + part['help'][1:])}.</p>")
            parts.append(choices_of(part))
            parts.append(keys_table(part))
    return "\n".join(parts)


def help_of(command, *arguments):
    return subprocess.run([command, *arguments, "--help"], capture_output=True, text=True, check=True,
                          env={"PATH": "/usr/bin:/bin", "COLUMNS": "110"}).stdout


def names_of_commands(command):
    listed = help_of(command).partition("Subcommands:\n")[2].partition("\n\n")[0]
    return re.findall(r"^  ([a-z]+) {2,}", listed, flags=re.M)


def commands(command, names):
    """HTML of --help, of the command and of each subcommand."""
    parts = ["<h1>Every command</h1>", f"<pre><code>{escaped(help_of(command).strip())}</code></pre>"]
    for name in names:
        parts.append(f'<h2 id="{name}">bernal {name}</h2>')
        parts.append(f"<pre><code>{escaped(help_of(command, name).strip())}</code></pre>")
    return "\n".join(parts)


def type_words(schema, definitions):
    """What a value is, in a word or two."""
    if "$ref" in schema:
        return type_words(definitions[schema["$ref"].rsplit("/", 1)[1]], definitions)
    if "anyOf" in schema:
        return " or ".join(dict.fromkeys(type_words(one, definitions) for one in schema["anyOf"]))
    if "enum" in schema:
        return ", ".join(f'"{w}"' for w in schema["enum"])
    kind = schema.get("type", "")
    if isinstance(kind, list):
        return " or ".join(kind)
    if kind == "array":
        return "array of " + type_words(schema.get("items", {}), definitions)
    return kind


def rows_of(schema, definitions, path=""):
    for name, value in schema["properties"].items():
        yield [cell(f"<code>{escaped(path + name)}</code>"), cell(escaped(type_words(value, definitions))),
               cell(phrase(value.get("description", "")), "what")]
        inner = value
        for one in value.get("anyOf", [value]):
            if "$ref" in one:
                one = definitions[one["$ref"].rsplit("/", 1)[1]]
            if one.get("type") == "object" and "properties" in one:
                inner = one
                yield from rows_of(inner, definitions, path + name + ".")
            items = one.get("items", {})
            if "$ref" in items:
                items = definitions[items["$ref"].rsplit("/", 1)[1]]
            if items.get("type") == "object":
                yield from rows_of(items, definitions, path + name + "[].")


def report_keys(schema):
    """HTML of report.json and of what measure and verify print."""
    definitions = schema["$defs"]
    head = ["key", "value", "what"]
    measured = definitions["measurements"]
    own = {"properties": {k: v for k, v in measured["properties"].items() if k not in schema["properties"]}}
    return "\n".join([
        "<h1>report.json and --json</h1>",
        f"<p>{phrase(schema['description'])} Its JSON Schema is <code>data/schemas/report.schema.json</code>, installed as "
        "<code>share/bernal/schemas/report.schema.json</code>; a test holds it against what runs of all kinds write.</p>",
        '<h2 id="report">report.json</h2>', table(head, rows_of(schema, definitions)),
        '<h2 id="measure">bernal measure --json</h2>',
        "<p>The same keys as far as they are of the spheres, <code>walls</code> with its layers, <code>sizes</code> with "
        "its tables, and these:</p>", table(head, rows_of(own, definitions)),
        '<h2 id="verify">bernal verify --json</h2>',
        "<p>What stands under <code>certificate</code>.</p>"])
