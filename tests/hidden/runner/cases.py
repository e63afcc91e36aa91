"""Which cases there are. A case is a dict with a key (its file name) and what hidden_data is asked."""
import json
import random
import subprocess
import zlib

SETS = ("controls", "varied", "poor", "slow", "effects", "outside", "pairs", "clutter", "one_load", "preloads",
        "real")
FLAGSHIP = "tension_friction.link=5"  # mu 0.2: Table 2's link friction, 3.3 to 7.0 N m with preload


REDUCED = 4  # cases of each set


def spread(some, n):
    """At most n of them, evenly."""
    return [some[i * len(some) // n] for i in range(n)] if len(some) > n else some


def tables(program):
    out = subprocess.run([program, "list"], check=True, capture_output=True, text=True).stdout
    return json.loads(out)


def case(kind, seed, effects=(), design="full", **more):
    size = "".join(f"-rho{more['rho']}" if "rho" in more else "")
    for name in ("clutter", "slow_noise"):
        size += f"-{name}{more[name]}" if name in more else ""
    key = "-".join([kind, design, *effects]) + f"{size}-s{seed}"
    return {"key": key, "kind": kind, "seed": seed, "effects": list(effects), "design": design, **more}


def sized(row, size):
    """The effect as hidden_data wants it, and rho when that is what was asked for."""
    if size.startswith("rho="):
        return row["id"], {"rho": float(size[4:])}
    return f"{row['id']}={size}", {}


def sizes(text):
    if text.startswith("rho="):
        return ["rho=" + part for part in text[4:].split(",")]
    return text.split(",")


def controls(options, rows, design):
    for seed in range(1, options.controls + 1):
        yield case("controls", seed, design=design)
    for row in rows:  # what the base model has is nothing to find
        if row["in_base"]:
            for seed in range(1, options.seeds + 1):
                yield case("controls", seed, [f"{row['id']}=1"], design)


def per_size(kind, options, rows, design):
    for row in rows:
        for size in sizes(options.sizes):
            for seed in range(1, options.seeds + 1):
                effect, more = sized(row, size)
                yield case(kind, seed, [effect], design, **more)


def free(kind, options, design, **more):
    """Nothing hidden, a quarter as often as the controls."""
    for seed in range(1, max(1, options.controls // 4) + 1):
        yield case(kind, seed, design=design, **more)


def pairs(options, rows, design):
    """Random pairs of different names and alias classes, each of rho 2.5 by itself: both can be seen."""
    draw = random.Random("pairs")
    for seed in range(1, 10 * options.seeds + 1):
        while True:
            one, two = draw.sample(rows, 2)
            alike = one["alias_class"] and one["alias_class"] == two["alias_class"]
            if one["name"] != two["name"] and not alike:
                break
        yield case("pairs", seed, [one["id"], two["id"]], design, rho=2.5)


def clutter(options, rows, design):
    yield from free("clutter_controls", options, design, clutter=0.1)
    for row in rows:
        for size in ("0.1", "0.3"):
            yield case("clutter", 1, [f"{row['id']}={size}"], design, clutter=0.1)


def real(options, table):
    for one in table["real"]:
        for ratio in (0.5, 1, 2):
            for seed in range(1, max(1, options.seeds // 2) + 1):
                yield {"key": f"real-{one['set']}-{one['effect']}-{ratio}-s{seed}", "kind": "real",
                       "seed": seed, "ratio": ratio, **one}


def half_without_controller(some):
    """Half of a set, drawn by its keys, as from a user who does not know it."""
    for one in some:
        if zlib.crc32(one["key"].encode()) % 2 == 1:
            one = {**one, "key": one["key"] + "-no_controller", "no_controller": True}
        yield one


def all_cases(options):
    table = tables(options.data)
    rows = [row for row in table["effects"] if row["form"] != "outside"]
    named = [row for row in rows if not row["in_base"]]
    matched = [row for row in named if row["form"] == "matched"]
    outside = [row for row in table["effects"] if row["form"] == "outside"]
    design = options.design
    if options.reduced:
        design, options.seeds, options.controls, options.sizes = "short", 1, 8, "1"
    makers = {
        "controls": lambda: controls(options, rows, design),
        "varied": lambda: (case("varied", seed, design="varied")
                           for seed in range(1, max(1, options.controls // 4) + 1)),
        "poor": lambda: free("poor", options, design, poor_sensors=True),
        "slow": lambda: free("slow", options, design, slow_noise=0.08),
        "effects": lambda: per_size("effects", options, named, design),
        "outside": lambda: per_size("outside", options, outside, design),
        "pairs": lambda: pairs(options, matched, design),
        "clutter": lambda: clutter(options, matched, design),
        "one_load": lambda: (case("one_load", 1, [f"{row['id']}=1"], "one_load") for row in matched),
        "preloads": lambda: (case("preloads", seed, effects, "preloads")
                             for seed in range(1, options.seeds + 1) for effects in ([FLAGSHIP], [])),
        "real": lambda: real(options, table) if options.shared else (),
    }
    wanted = options.sets.split(",")
    chosen = [list(makers[name]() if name in ("real", "varied") else half_without_controller(makers[name]()))
              for name in SETS if name in wanted]
    return [one for some in chosen for one in (spread(some, REDUCED) if options.reduced else some)]
