"""Makes a case, runs the tool on it, writes one result file, whole or not at all."""
import concurrent.futures
import json
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile
import time

COMMAND = "{prepare}{cablefit} refine {given} {test_option} {excite_option} --out out --quiet --json -"
PREPARE = "{cablefit} {fit} --out out --quiet >/dev/null && "
FITS = {"emps": ("dynamic --model rigid {train}", "out/dynamic.json"),
        "xl330": ("dynamic --model rigid {train}", "out/dynamic.json"),
        "sea": ("elastic {blocked}", "out/elastic.json")}
ADVISED_LOAD = -40  # N m, of the further run when the tool writes no reference of its own
TIMEOUT = 600  # s, of one run of the tool


def make(case, options, folder, extra=()):
    """Logs in `folder`; returns the truth, which is taken away from there."""
    if case["kind"] == "real":
        words = ["plant", "--data", options.shared, "--set", case["set"], "--effect", case["effect"],
                 "--ratio", str(case["ratio"])]
    elif case["kind"] == "varied":
        words = ["varied"]
    else:
        words = ["case", "--design", case["design"]]
        for effect in case["effects"]:
            words += ["--effect", effect]
        for name in ("rho", "clutter", "slow_noise"):
            if name in case:
                words += ["--" + name.replace("_", "-"), str(case[name])]
        for name in ("no_controller", "poor_sensors"):
            if case.get(name):
                words.append("--" + name.replace("_", "-"))
    words += ["--seed", str(case["seed"]), "--out", str(folder), *extra]
    subprocess.run([os.path.abspath(options.data), *words], check=True, stdin=subprocess.DEVNULL)
    file = folder / "truth.json"
    truth = json.loads(file.read_text())
    file.unlink()
    return truth


def ask(case, truth, options, folder, truth_file):
    """Runs the tool; returns its answer (None when it gave none), exit code, seconds and complaint."""
    logs = {role: " ".join(map(shlex.quote, files)) for role, files in truth["logs"].items()}
    # The tool runs in the folder of the logs, where a relative path leads nowhere.
    tool = os.path.abspath(options.cablefit) if "/" in options.cablefit else options.cablefit
    fields = {"cablefit": shlex.quote(tool), "truth": shlex.quote(str(truth_file)), **logs,
              "prepare": "", "given": " ".join(filter(None, (logs["blocked"], logs["train"]))),
              "test_option": f"--test {logs['test']}" if logs["test"] else "",
              "excite_option": "--excite advised.csv" if case["kind"] == "one_load" else ""}
    if case.get("set") in FITS:  # a model of an earlier stage, which moves or is blocked
        fit, model = FITS[case["set"]]
        fields["prepare"] = PREPARE.format(cablefit=fields["cablefit"], fit=fit.format(**logs))
        blocked = f" --blocked {logs['blocked']}" if logs["blocked"] else ""
        fields["given"] = f"{model} --train {logs['train']}{blocked}"
    start = time.monotonic()
    try:
        done = subprocess.run(options.command.format(**fields), shell=True, cwd=folder, text=True,
                              capture_output=True, stdin=subprocess.DEVNULL, timeout=TIMEOUT)
        code, out, err = done.returncode, done.stdout, done.stderr
    except subprocess.TimeoutExpired:
        code, out, err = None, "", f"no answer within {TIMEOUT} s"
    answer = None
    if code in (0, 1, 4):  # 1: a gate; 4: not identifiable. An answer stands beside both
        try:
            answer = json.loads(out)
        except ValueError:
            err += "\nno JSON on stdout"
    return {"answer": answer, "exit": code, "seconds": time.monotonic() - start, "stderr": err[-2000:]}


def run(case, options):
    with tempfile.TemporaryDirectory(prefix="hidden-") as parent:
        folder, truth_file = pathlib.Path(parent) / "logs", pathlib.Path(parent) / "truth.json"
        truth = make(case, options, folder)
        truth_file.write_text(json.dumps(truth))
        result = {"case": case, "truth": truth, **ask(case, truth, options, folder, truth_file)}
        if case["kind"] == "one_load":  # the experiment that the tool asks for, and the answer then
            advised = folder / "advised.csv"
            extra = ["--extra-load", str(ADVISED_LOAD)]
            if advised.exists():
                extra += ["--extra", str(advised)]
            truth = make(case, options, folder, extra)
            result["with_advised"] = ask(case, truth, options, folder, truth_file)
        return result


def finished(file, options):
    if not file.exists():
        return False
    return not options.retry or json.loads(file.read_text())["answer"] is not None


def write(folder, result):
    handle, name = tempfile.mkstemp(prefix=".new-", dir=folder)
    with os.fdopen(handle, "w") as out:
        json.dump(result, out, indent=1)
    os.replace(name, folder / (result["case"]["key"] + ".json"))


def run_all(cases, options):
    folder = pathlib.Path(options.results)
    folder.mkdir(parents=True, exist_ok=True)
    left = [one for one in cases if not finished(folder / (one["key"] + ".json"), options)]
    print(f"{len(cases)} cases, {len(cases) - len(left)} of them done before", file=sys.stderr)
    left = left[:options.limit]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        futures = [pool.submit(run, one, options) for one in left]
        try:
            for count, future in enumerate(concurrent.futures.as_completed(futures), 1):
                result = future.result()
                write(folder, result)
                verdict = (result["answer"] or {}).get("verdict", f"FAILED, exit {result['exit']}")
                print(f"{count}/{len(left)} {result['case']['key']}: {verdict}", file=sys.stderr)
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def read_all(folder):
    return [json.loads(file.read_text()) for file in sorted(pathlib.Path(folder).glob("[!.]*.json"))]
