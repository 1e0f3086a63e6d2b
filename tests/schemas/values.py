"""Good and bad values of every key that a scene may hold, as TOML, made from `bernal keys --json`."""

from dataclasses import dataclass

# What rules between keys ask of those that are given together.
FITTING = {
    "max": "5", "d43": "2", "d32": "1", "values": "[1, 2]", "shares": "[1, 1]", "x": "[1, 2]",
    "density": "[0, 1]", "sizes": "[1, 2]", "passing": "[0, 100]",
    "retained": "[100, 0]", "edges": "[1, 2, 3]", "counts": "[1, 1]", "masses": "[1, 1]", "of": "[1, 2]", "dimension": "3",
    "inner_radius": "0.5", "vertices": "[[0, 0], [9, 0], [0, 9]]", "contact": '"gap"',
    "place": '"z < 5"',
}
GOOD = {
    "flag": ["true"], "length": ["1", "0.25", "1e-30", "1e30"], "file": ['"part.stl"'],
    "text": ['"sand"', '"glass of 3 mm"'],
    "direction": ["[0, 0, -1]", "[1e-5, 0, 0]"], "push": ["[0, 0, 1]", "[0, -1]"],
    "position": ["[0, -1, 2.5]"], "names": ['"first"', '["first", "second"]', "[2]", "3"],
    "corner": ["[0, 1, 2]", "[0, 1]"], "extents": ["[1, 2, 3]", "[1, 2]"],
    "points": ["[[0, 0], [9, 0], [0, 9]]"], "lines": ["[[[1, 1], [2, 1], [1, 2]]]"],
    "coordinates": ["[1, -2]"], "lengths": ["[1, 2, 3]"], "shares": ["[1, 1]"], "amounts": ["[0, 1]"],
    "axes": ["[2]", "[]", "[0, 1]"], "distribution": ["1", '{ distribution = "constant", value = 2 }'],
    "parts": ["[1, 2]", '[{ distribution = "mixture", of = [1, { distribution = "uniform", min = 1, '
              'max = 2 }], shares = [1, 2] }, 3]'],
    "solids": ['"part.stl"', '["part.stl", "other.stl"]', '[{ kind = "sphere", radius = 1 }, "part.stl"]'],
    "table": ["{ volume = 2 }", '{ diameter = { distribution = "uniform", min = 1, max = 2 }, rounds = 0 }'],
    "tables": ['[{ name = "core" }]', '[{ name = "core" }, { name = "shell", share = 0.25, material_density = "2 g/cm3" }]'],
    "table_lists": ['[[{ name = "core" }, { name = "shell", share = 0.25 }], []]'],
    "inside": ['[{ scene = "inner.toml" }]', '{ scene = "inner.toml", templates = 3 }'],
}
BAD = {
    "flag": ["1", '"true"', "[]"], "integer": ['"3"', "1.5", "true", "[1]", "1e31"], "number": ["true", "[1]", "{}"],
    "length": ["0", "-1", '"1"', "1e31", "1e-31", "[1]", "true"], "word": ['"nonsense"', "1", '""', "[]"],
    "file": ['""', "1", "[]"], "text": ['""', "1", '"a, b"', "[]"], "direction": ["[0, 0, 0]", "[0, 1]", "[1, 2, 3, 4]", "1", '["a", 0, 0]'],
    "push": ["[0, 0]", "[1]", "[1, 2, 3, 4]", "1"], "position": ["[0, 1]", "1", "[1, 2, 3, 4]", "[1e31, 0, 0]"],
    "names": ["[]", "true", '[""]', '""', "1.5"], "corner": ["[1]", "[1, 2, 3, 4]", "1"],
    "extents": ["[1]", "[1, 2, 0]", "[1, 2, 3, 4]", "1"], "points": ["[[0, 0], [1, 1]]", "[[0, 0], [1, 0], [1]]", "1"],
    "lines": ["[[0, 0], [1, 0], [0, 1]]", "[[[0, 0]]]", "1"], "coordinates": ["[]", "1", '["a"]'],
    "lengths": ["[]", "[0]", "[1, -1]", "1", '["a"]'], "shares": ["[]", "[1, 0]", "1"],
    "amounts": ["[]", "[1, -1]", "1"], "axes": ["[-1]", "[8]", "[0, 0]", "[0.5]", "1"],
    "distribution": ["0", "-1", '"x"', "[1]", "{}", '{ distribution = "nonsense" }',
                     '{ distribution = "uniform", min = 1 }', '{ distribution = "constant", value = 1, sigma = 1 }'],
    "parts": ["[]", "1", "[0]", '[1, { distribution = "nonsense" }]'],
    "solids": ["[]", "1", '""', "[1]", '[{ kind = "periodic", edge = 1 }]', '[{ kind = "sphere" }]'],
    "table": ["[]", "1", '""', "{}", "[{ volume = 2 }]", "{ volume = 0 }", "{ volume = 1, diameter = 1 }",
              "{ volume = 1, rounds = -1 }", "{ volume = 1, name = 1 }"],
    "tables": ["[]", "1", '""', "[1]"],
    "inside": ["[]", "1", '"inner.toml"', "[1]", "{}", "{ templates = 3 }", '{ scene = "inner.toml", templates = 0 }',
               '{ scene = "inner.toml", class = "a, b" }', '[{ scene = "inner.toml", turned = true }]'],
    "table_lists": ["[]", "1", "[1, 2]", '[{ name = "core" }, { name = "shell" }]', '[[{ share = 0.5 }], []]'],
}


def text_of(number):
    """A limit as TOML: whole ones without a point."""
    return str(int(number)) if number == int(number) and abs(number) < 2**63 else repr(number)


def kind_of(key):
    """Whose values it takes: those of its type, but for tables of another kind than layers."""
    return "inside" if key["name"] == "inside" else key["type"]


def good_values(key):
    if key["words"] and key["type"] in ("word", "names"):
        return [f'"{word}"' for word in key["words"]]
    if key["type"] in ("integer", "number"):
        low, high, whole = key["min"], key["max"], key["type"] == "integer"
        values = [f'"{word}"' for word in key["words"]]
        if low is not None and not key["above_min"]:
            values.append(text_of(low))
        if high is not None and not key["below_max"] and high < 2**53:
            values.append(text_of(high))
        if low is not None and high is not None and not whole:
            values.append(repr(0.5 * (low + min(high, low + 1))))
        return values or ["1"]
    values = GOOD[kind_of(key)] + [f'"{word}"' for word in key["words"]]
    return ["true"] if key["type"] == "flag" and key["min"] else values


def bad_values(key, seen):
    from_zero = key["type"] == "lengths" and key["min"] == 0
    kind = kind_of(key)
    values = list(some(BAD["amounts" if from_zero else kind], seen, ("bad", kind, from_zero)))
    if key["type"] == "flag" and key["min"]:
        values.append("false")
    if key["type"] in ("integer", "number"):
        low, high, step = key["min"], key["max"], 1
        if low is not None:
            values.append(text_of(low) if key["above_min"] else text_of(low - max(step, abs(low))))
        if high is not None and high < 2**53:
            values.append(text_of(high) if key["below_max"] else text_of(high + step))
        values.append('"nonsense"')
    if key["words"] and key["type"] == "names":
        values.append('"nonsense"')
    return values


def some(values, seen, kind):
    """All values the first time that their kind is seen, then one in turn: to start the command takes longest."""
    count = seen.get(kind, 0)
    seen[kind] = count + 1
    return values if count == 0 else [values[count % len(values)]]


@dataclass
class Table:
    """A table of the reference, and how a scene is made of what stands in it."""
    group: str
    selector: str
    name: str
    keys: dict
    choices: list

    def needed(self, index=0, asked=None):
        """A good value of each key that must be there, with the index-th set of every choice, or of those with the key
        that is asked for and the first of the others."""
        inside, out = set(), set()
        for choice in self.choices:
            is_meant = asked is None or any(asked in one for one in choice)
            kept = choice[index % len(choice) if is_meant else 0]
            inside |= set(kept)
            out |= {key for one in choice for key in one if key not in kept}
        lines = {}
        for name, key in self.keys.items():
            if name in out or not (key["required"] or (name in inside and key["default"] is None)):
                continue
            lines[name] = FITTING.get(name, good_values(key)[0])
        return lines

    def index_with(self, key):
        """Of a set of its choices with that key; 0 where no choice speaks of it."""
        for choice in self.choices:
            for index, one in enumerate(choice):
                if key in one:
                    return index
        return 0

    def scene(self, lines):
        body = [f'{self.selector} = "{self.name}"'] if self.selector else []
        body += [f"{key} = {value}" for key, value in lines.items()]
        sphere = 'container = { kind = "sphere", radius = 9 }\n'
        spheres = "[spheres]\ncount = 3\nradius = 1\n"
        if self.group == "container":
            return 'unit = "mm"\n[container]\n' + "\n".join(body) + "\n" + spheres
        if self.group == "diameter":
            return sphere + "[spheres]\ncount = 3\ndiameter = { " + ", ".join(body) + " }\n"
        if self.group in ("stage", "output"):
            return sphere + spheres + f"[[{self.group}]]\n" + "\n".join(body) + "\n"
        if self.group == "zone":
            box = 'container = { kind = "box", size = [20, 20, 20] }\n'
            return 'unit = "mm"\n' + box + "[[zone]]\n" + "\n".join(body) + "\n"
        if self.group == "engine":
            return sphere + spheres + "[engine]\n" + "\n".join(body) + "\n"
        if self.name == "scene":
            return "\n".join(body) + "\n" + sphere + spheres
        if self.name == "spheres" and "cells" in lines:  # which are of boxes, and as many as are counted
            body = [line for line in body if not line.startswith(("fill", "count"))]
            return '[container]\nkind = "periodic"\n[spheres]\ncount = 3\n' + "\n".join(body) + "\n"
        if self.name == "spheres":
            return sphere + "[spheres]\n" + "\n".join(body) + "\n"
        return sphere + spheres + f"[{self.name}]\n" + "\n".join(body) + "\n"


def tables_of(reference):
    """All but tables that stand within others: their values are samples of the keys that they stand in."""
    for group in reference["groups"]:
        if group["name"] == "table":
            continue
        for table in group["tables"]:
            yield Table(group["name"], group["selector"], table["name"],
                        {key["name"]: key for key in table["keys"]}, table["choices"])
