#!/usr/bin/env python3
"""Plans of 384 benches: distance to what no plan beats, against the paper's plan, and time.

    cargo build --release -p tumble && python3 benches/plan_sweep.py target/release/tumble

Only the standard library. Every plan is a process of its own: its start is in the time.
"""

import itertools
import json
import subprocess
import sys
import time

TABLES = ([30, 45, 65, 90], [0.75, 1, 2, 4], [0.5, 3], [0.1, 1, 5], [False, True], ["", "k2"])


def main(binary):
    plans = []
    for half, hours, scatter, step, updown, terms in itertools.product(*TABLES):
        args = [binary, "plan", "--range", str(half), "--hours", str(hours), "--scatter", f"{scatter}arcmin"]
        args += ["--step", f"{step}deg"] + ["--updown"] * updown + ["--terms", terms] * bool(terms) + ["--json"]
        start = time.perf_counter()
        done = subprocess.run(args, capture_output=True, text=True)
        took = time.perf_counter() - start
        if done.returncode == 2:
            sys.exit(f"{' '.join(args)}: {done.stderr}")
        plan = json.loads(done.stdout)
        ours, paper = plan["predicted"], plan["paper"]
        bias = paper["predicted"][0]["u_statistical"] / ours[0]["u_statistical"] if paper else None
        plans.append((plan["gap"], took, bias, half, updown, len(plan["positions"]), args))
    gaps = sorted(p[0] for p in plans)
    print(f"{len(plans)} plans; gap: median {100 * gaps[len(gaps) // 2]:.2f} %, largest {100 * gaps[-1]:.2f} %")
    far = [p for p in plans if p[0] > 0.01]
    print(f"above 1 %: {len(far)}")
    for gap, _, _, half, _, dwells, args in sorted(far, key=lambda p: -p[0]):
        print(f"  {100 * gap:.2f} %, {dwells} dwells a run: {' '.join(args[1:-1])}")
    times = sorted(p[1] for p in plans)
    print(f"time: median {times[len(times) // 2]:.3f} s, longest {times[-1]:.3f} s")
    for half, updown in itertools.product(TABLES[0], TABLES[4]):
        some = sorted(p[2] for p in plans if p[3] == half and p[4] == updown and p[2])
        print(f"bias scatters less than the paper's plan, +-{half} deg, up and down {updown}: {some[0]:.1f} to {some[-1]:.1f} times")


if __name__ == "__main__":
    main(*sys.argv[1:])
