"""One result against its truth: plain functions, no input or output."""
import math

ANGLES = ("phase", "t0")  # places in time or angle: no relative error


def alias_class(name, side):
    """Contract: names in one class cannot be told apart by any log."""
    if (name, side) in (("constant_torque", "link"), ("asymmetric_coulomb", "link")):
        return "constant"
    return {"torque_gain": "scale", "load_scale": "scale", "dead_zone": "l_o", "preload": "l_o"}.get(name)


def family(effect):
    """What an answer and a truth have in common when the answer is right."""
    name, side = effect["name"], effect["side"]
    return alias_class(name, side) or f"{name}.{side}"


def listed(answer):
    """Headline and rivals."""
    effects = answer.get("effects") or []
    return effects[:1] + (effects[0].get("rivals") or [] if effects else [])


def names_something(answer):
    return answer["verdict"] in ("named", "ambiguous") and bool(answer.get("effects"))


def truths(result):
    return [one for one in result["truth"]["effects"] if not one["in_base"] and one["form"] != "outside"]


def judge(result, which=None):
    """Of a result with one hidden effect: how the answer relates to it. `which`: a later answer."""
    answer = (result if which is None else result[which])["answer"]
    truth = truths(result)[0]
    if answer is None:
        return {"said": "failed", "top": False, "in_set": False, "size": 0, "wrong": False}
    if not names_something(answer):
        return {"said": answer["verdict"], "top": False, "in_set": False, "size": 0, "wrong": False}
    families = [family(one) for one in listed(answer)]
    in_set = family(truth) in families
    return {"said": families[0], "top": families[0] == family(truth), "in_set": in_set,
            "size": len(set(families)), "wrong": not in_set}


def aliases_listed(result):
    """Of a truth that has aliases: are two names of its class in the list? None: it has none."""
    truth = truths(result)[0]
    if not alias_class(truth["name"], truth["side"]) or alias_class(truth["name"], truth["side"]) == "l_o":
        return None  # l_o > 0 and l_o < 0 are one parameter; its sign tells them apart
    answer = result["answer"]
    if answer is None or not names_something(answer):
        return None
    same = [one["name"] for one in listed(answer) if family(one) == family(truth)]
    return len(set(same)) >= 2


def both_named(result):
    answer = result["answer"]
    if answer is None or not names_something(answer):
        return False
    said = {family(one) for one in answer["effects"]}
    return all(family(one) in said for one in truths(result))


def planted_named(result):
    """Is the planted effect among all that are named, or a rival of one? Real logs have effects of
    their own, which may be the larger ones."""
    answer = result["answer"]
    if answer is None or not names_something(answer):
        return False
    said = {family(one) for effect in answer["effects"] for one in [effect] + (effect.get("rivals") or [])}
    return family(truths(result)[0]) in said


def removed(gap):
    """Share of the squared gap above the floor that the effect removed on unseen logs; None when the
    gap is not known, or before was hardly above it."""
    before, after, floor = gap["test_before"], gap["test_after"], gap["noise_floor"]
    if None in (before, after, floor) or before <= 1.1 * floor:
        return None
    return 1 - (after ** 2 - floor ** 2) / (before ** 2 - floor ** 2)


def counterpart(coefficient, truth, parameters):
    """The answer's parameter: by name, or the only one on both sides with this unit."""
    for one in parameters:
        if one["name"] == coefficient["name"]:
            return one
    unit = coefficient["unit"]
    alike = [one for one in parameters if one.get("unit") == unit]
    alone = [one for one in truth["coefficients"] if one["unit"] == unit]
    return alike[0] if len(alike) == 1 and len(alone) == 1 else None


def coefficients(result):
    """(relative error, inside the 95 % interval or None) of each coefficient of a rightly named effect.
    Magnitudes: the sign of an amplitude with a phase is a convention."""
    truth, effect = truths(result)[0], result["answer"]["effects"][0]
    out = []
    for one in truth["coefficients"]:
        found = counterpart(one, truth, effect.get("parameters") or [])
        if found is None or found.get("value") is None or one["name"] in ANGLES or one["value"] == 0:
            continue
        turn = math.copysign(1, found["value"])
        size, interval = abs(one["value"]), found.get("ci95")
        inside = None
        if interval and None not in interval:
            low, high = sorted(turn * end for end in interval)
            inside = low <= size <= high
        out.append((abs(abs(found["value"]) - size) / size, inside))
    return out


def upper_bound(hits, n, level=0.95):
    """Clopper & Pearson 1934, one-sided: the largest rate at which so few hits are still likely."""
    if n == 0 or hits == n:
        return 1.0
    low, high = 0.0, 1.0
    for _ in range(60):
        p = (low + high) / 2
        few = sum(math.comb(n, k) * p ** k * (1 - p) ** (n - k) for k in range(hits + 1))
        low, high = (p, high) if few > 1 - level else (low, p)
    return high


def kolmogorov(values):
    """Distance of the distribution of `values` from a uniform one on 0 .. 1, and the chance of such a
    distance (Kolmogorov 1933, for finite n by Stephens 1970); nothing for no values."""
    if not values:
        return None
    n = len(values)
    ordered = sorted(values)
    distance = max(max((i + 1) / n - v, v - i / n) for i, v in enumerate(ordered))
    root = math.sqrt(n)
    x = (root + 0.12 + 0.11 / root) * distance
    chance = 2 * sum((-1) ** (k - 1) * math.exp(-2 * k * k * x * x) for k in range(1, 101)) if x > 0.2 else 1
    return distance, min(1.0, max(0.0, chance))


FIRST_DRAWS = 6


def step_of_p(p, draws):
    """Height of the step of a counted p. More than the first draws are made where none of these came as
    far as the logs; j of the later ones then do with C(later, j) / C(draws, j) / (1 + draws)."""
    later = draws - FIRST_DRAWS
    if later <= 0 or p > 1 / (1 + FIRST_DRAWS) + 1e-9:
        return 1 / (1 + min(draws, FIRST_DRAWS))
    total, step = 0, 1 / (1 + draws)
    for j in range(later + 1):
        total += step
        if total >= p - 1e-9:
            break
        step *= (later - j) / (draws - j)
    return step


def search_p(result, draw):
    """p of the whole search; None: not told. One that is counted among simulated data sets has steps:
    `draw` (uniform on 0 .. 1) chooses in its step."""
    search = (result["answer"] or {}).get("search") or {}
    p = search.get("p_value")
    if p is None or search.get("p_is_fitted") or not search.get("draws"):
        return p
    return p - draw() * step_of_p(p, search["draws"])


def quantile(values, share):
    """Linear between order statistics."""
    if not values:
        return None
    values = sorted(values)
    at = share * (len(values) - 1)
    low = int(at)
    high = min(low + 1, len(values) - 1)
    return values[low] + (at - low) * (values[high] - values[low])
