#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes docs/ENGINES.md: the fast engine beside the reference, on every example scene.

Usage: make_engine_table.py PROGRAM [FOLDER]

FOLDER holds the scenes, data/scenes if left out. Takes a few minutes; times are ratios of one run.
"""
import json
import os
import subprocess
import sys
import tempfile

# Pixels and samples; those that take long have fewer.
USUAL = ("160x90", "32")
DEAR = {"failure-shaft": ("24x24", "4"), "steam": ("64x36", "8"), "slab": ("64x36", "16"),
        "air-ground": ("64x36", "8"), "air-space": ("48x48", "8"), "failure-halo": ("64x64", "8"),
        "terrain": ("96x54", "16"), "city": ("96x54", "16")}

HEAD = """# The engines beside each other

`airlight render` has two engines for light that is scattered once. The reference integrates: closed forms or adaptive
quadrature along rays, Monte Carlo for the map and for what media send onto surfaces, with stated noise. The fast
engine has the papers' closed forms, tables and products, nothing in it is drawn at random, and a sketch of the
picture chooses its methods for the scene's tolerance. This page is what `airlight render --compare` says of the scenes
in `data/scenes`, each at its own tolerance; `scripts/make_engine_table.py` makes it.

Errors are over the brightest pixel: root mean square (rms) and what 99 % of the pixels stay under. The reference's
own noise is part of them. "Bound" is the plan's word for the error. "Times" is the reference's time over the fast
engine's, tables included, on a machine with other work; small pictures have many tables for few pixels.

"""


def number(value):
    return "0" if value == 0 else f"{value:.1e}"


def compare(program, scene, size, samples):
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([program, "render", scene, "-o", os.path.join(folder, "a.pfm"),
                               "--compare", "--size", size, "--samples", samples, "--json", "-q"],
                              check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def main():
    program = sys.argv[1]
    folder = sys.argv[2] if len(sys.argv) > 2 else os.path.join(
        os.path.dirname(os.path.abspath(__file__)), "..", "data", "scenes")
    names = sorted(f[:-5] for f in os.listdir(folder) if f.endswith(".json"))
    reports = {name: compare(program, os.path.join(folder, name + ".json"),
                             *DEAR.get(name, USUAL)) for name in names}
    text = HEAD
    text += "| scene | times | rms | noise | 99 % | bound | most of it |\n"
    text += "| --- | --- | --- | --- | --- | --- | --- |\n"
    for name, r in reports.items():
        e = r["errors"]
        text += (f"| {name} | {r['speedup']:.1f} | {number(e['rms'])} | "
                 f"{number(r['reference_noise'])} | {number(e['p99'])} | "
                 f"{number(r['plan']['bound'])} | {r['owner']} |\n")
    layers = list(next(iter(reports.values()))["layers"])
    text += ("\n## By light\nThe rms error of each kind of light, over the whole picture's "
             "brightest pixel.\n\n")
    text += "| scene | " + " | ".join(layers) + " |\n| --- |" + " --- |" * len(layers) + "\n"
    for name, r in reports.items():
        text += f"| {name} | " + " | ".join(number(r["layers"][l]["rms"]) for l in layers) + " |\n"
    text += "\n## Methods\nThose that the plans chose.\n\n| scene | methods |\n| --- | --- |\n"
    for name, r in reports.items():
        chosen = [f"{effect} {c['method']}" for effect, c in r["plan"]["effects"].items()
                  if c["runs"] and c["method"]]
        text += f"| {name} | {', '.join(chosen)} |\n"
    page = os.path.join(folder, "..", "..", "docs", "ENGINES.md")
    with open(page, "w", newline="\n", encoding="utf-8") as out:
        out.write(text)


if __name__ == "__main__":
    main()
