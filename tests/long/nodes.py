#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""A sweep over several nodes, which lose their power: nodes are network namespaces with names and addresses of their own,
whose processes see each other over TCP only. The table after kills of whole nodes and --resume on those that are left is
that of one process; 16 ranks share the 4 nodes. Points cost from 0.5 ms to 0.1 s.

    python3 nodes.py PATH_TO_CRAWLER MPIEXEC [KILLS]        77 if it may not make namespaces (root and iproute2 can)
"""
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, environment, expect, prm  # noqa: E402
from tables import h5_columns, same_columns  # noqa: E402

PROGRAM, MPIEXEC = str(pathlib.Path(sys.argv[1]).resolve()), shutil.which(sys.argv[2])
KILLS = int(sys.argv[3]) if len(sys.argv) > 3 else 3
NODES, RANKS_OF_NODE = 4, 4
NET = f"10.{os.getpid() % 200 + 20}.{os.getpid() // 200 % 250}"
NAME = f"crawler{os.getpid()}"
SCENE = prm("Accuracy=1e-7", "Active stress/Optimal wave/Choose wave by=wave speed",
            "Sweep/Axes=Body/Anchoring exponent : linspace(-1, 4, 42); Time/End time : 1, 30; "
            "Active stress/Optimal wave/Perturbation parameter : 0.1, 0.2, 0.3, 0.45; Body/Elastic modulus : 1, 3; "
            "Body/Friction profile : 1, 1+0.3*sin(6*s)")


def ip(*words, **more):
    """One call of iproute2."""
    return subprocess.run(["ip", *words], check=True, capture_output=True, text=True, **more).stdout


def node(i):
    """The name of a node's namespace."""
    return f"{NAME}n{i}"


def make_nodes():
    """A bridge with a cable to each node."""
    ip("link", "add", f"{NAME[-9:]}b", "type", "bridge")
    ip("addr", "add", f"{NET}.254/24", "dev", f"{NAME[-9:]}b")
    ip("link", "set", f"{NAME[-9:]}b", "up")
    for i in range(NODES):
        outer = f"{NAME[-9:]}v{i}"
        ip("netns", "add", node(i))
        ip("link", "add", outer, "type", "veth", "peer", "name", "eth0", "netns", node(i))
        ip("link", "set", outer, "master", f"{NAME[-9:]}b", "up")
        for words in (["addr", "add", f"{NET}.{i + 1}/24", "dev", "eth0"], ["link", "set", "eth0", "up"], ["link", "set", "lo", "up"]):
            ip("-n", node(i), *words)


def power_off(i):
    """Kills all processes of a node at once."""
    for process in ip("netns", "pids", node(i)).split():
        try:
            os.kill(int(process), signal.SIGKILL)
        except ProcessLookupError:
            pass


def remove_nodes():
    """Takes all of it away."""
    for i in range(NODES):
        if subprocess.run(["ip", "netns", "pids", node(i)], capture_output=True, check=False).returncode == 0:
            power_off(i)
        subprocess.run(["ip", "netns", "del", node(i)], capture_output=True, check=False)
    subprocess.run(["ip", "link", "del", f"{NAME[-9:]}b"], capture_output=True, check=False)


def sweep(folder, nodes, *options, stop_at=None):
    """Starts the sweep on some nodes; with `stop_at` each rank stops behind so many rows, and goes on at SIGCONT only."""
    stops = ["-x", f"CRAWLER_STOP_AT=row:{stop_at}:STOP"] if stop_at else []
    hosts = ",".join(f"{NET}.{i + 1}:{RANKS_OF_NODE}" for i in nodes)
    words = [MPIEXEC, "--host", hosts, "-n", str(RANKS_OF_NODE * len(nodes)), "--oversubscribe", "--bind-to", "none",
             "--mca", "plm_rsh_agent", str(folder / "remote_shell"), "--mca", "btl", "tcp,self", "--mca", "pml", "ob1",
             "--mca", "oob_tcp_if_include", f"{NET}.0/24", "--mca", "btl_tcp_if_include", f"{NET}.0/24",
             "--mca", "orte_keep_fqdn_hostnames", "1", "--mca", "mpi_yield_when_idle", "1",
             *stops, PROGRAM, "sweep", "sweep.prm", "--output", "nodes", *options]
    return subprocess.Popen(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True,
                            env=environment())


def table(folder):
    return h5_columns(folder / "results.h5", "results")


def finished_rows(folder):
    """How many rows a table has that may be written to at this moment."""
    done = call([sys.executable, "-c", "import sys, h5py\nwith h5py.File(sys.argv[1], 'r', locking=False) as f:\n"
                 " print(int((f['results/status'][()] != b'').sum()))", folder / "results.h5"])
    return int(done.stdout) if done.returncode == 0 else 0


def wait_for_more_rows(process, folder, n):
    """Waits until there are more rows than that; False if the sweep ends before."""
    while process.poll() is None:
        if finished_rows(folder) > n:
            return True
    return False


def main(folder):
    if os.geteuid() != 0 or shutil.which("ip") is None:
        print("namespaces need root and iproute2")
        sys.exit(77)
    generator = random.Random(5)
    (folder / "sweep.prm").write_text(SCENE)
    remote_shell = folder / "remote_shell"  # what mpirun calls in the place of ssh: remote_shell HOST COMMAND...
    remote_shell.write_text("#!/bin/sh\nnode=$1; shift; i=$((${node##*.} - 1))\n"
                            f"exec ip netns exec {NAME}n$i unshare --uts sh -c \"hostname node$i; $*\"\n")
    remote_shell.chmod(0o755)
    try:
        try:
            make_nodes()
        except subprocess.CalledProcessError as error:
            print(f"no namespaces here: {error.stderr.strip()}")
            sys.exit(77)
        done = call([PROGRAM, "sweep", "sweep.prm", "--output", "one"], folder)
        if done.returncode != 0:
            sys.exit(f"one process: {done.stderr}")
        reference = table(folder / "one")
        n_rows = finished_rows(folder / "one")
        rows, killed, nodes = 0, 0, list(range(NODES))
        for k in range(KILLS):
            victim, stop_at = generator.choice(nodes), generator.randint(1, n_rows // (4 * KILLS * NODES * RANKS_OF_NODE))
            process = sweep(folder, nodes, *(["--resume"] if k > 0 else []), stop_at=stop_at)
            expect(wait_for_more_rows(process, folder / "nodes", rows), f"{stop_at} rows of a rank before a node is off")
            power_off(victim)
            process.communicate()
            killed += 1
            before, rows = rows, finished_rows(folder / "nodes")
            expect(process.returncode != 0 and before < rows, f"node {victim} of {nodes} off: {rows} rows, {before} before")
            nodes = [i for i in range(NODES) if i != victim] if k % 2 == 0 else list(range(NODES))
        process = sweep(folder, nodes, "--resume")
        text, _ = process.communicate()
        expect(process.returncode == 0, f"the last one, on nodes {nodes}: {process.returncode}, {text[-600:]}")
        expect(rows < n_rows, f"{killed} nodes were switched off under way: {rows} of {n_rows} rows before the last start")
        expect(same_columns(reference, table(folder / "nodes")), f"the table is that of one process ({len(nodes) * RANKS_OF_NODE} ranks)")
    finally:
        remove_nodes()


checks.run((main,))
