#!/usr/bin/python3
"""Slurm runs the job array that bernal sweep writes, and the script that starts an engine:
tests/clients/with_slurm.py [BERNAL]

Debian: slurm-wlm, munge; for the engine lammps, openmpi-bin. Where no cluster answers, one of this machine alone is
started for it, which takes root. Takes half a minute.
"""
import csv
import os
import signal
import socket
import time

from client import *

SBATCH = need_program("sbatch", "slurm-wlm")

BED = """[container]
kind = "periodic"
[spheres]
count = 30
radius = 1
[[stage]]
do = "relax"
"""
BY_ENGINE = """[container]
kind = "periodic"
[spheres]
count = 500
diameter = 1.0
[engine]
kind = "lammps"
launcher = "slurm"
ranks = 2
command = {command}
slurm = ["--oversubscribe", "--time=5"]
"""
SWEEP = """scene = "bed.toml"
[grid]
"stage[0].alpha" = [2, 4, 8]
seed = { from = 1, to = 4 }
"""


def answers(*command):
    return subprocess.run(command, capture_output=True).returncode == 0


def start_munge():
    if answers("munge", "-n"):
        return
    need_program("munged", "munge")
    for place in ("/etc/munge", "/run/munge", "/var/log/munge", "/var/lib/munge"):
        Path(place).mkdir(parents=True, exist_ok=True)
        run("chown", "-R", "munge:munge", place, folder="/")
    run("runuser", "-u", "munge", "--", "munged", folder="/")


def start_cluster(folder):
    """A controller and a node, both on this machine; returns how to end them."""
    if os.geteuid() != 0:
        print("skipped: no cluster answers, and only root can start one", flush=True)
        sys.exit(SKIPPED)
    start_munge()
    host = socket.gethostname().split(".")[0]
    for name in ("state", "spool"):
        (folder / name).mkdir(parents=True)
    (folder / "slurm.conf").write_text(f"""ClusterName=here
SlurmctldHost={host}
SlurmctldPort=16817
SlurmdPort=16818
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
ReturnToService=2
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
NodeName={host} CPUs={os.cpu_count()} RealMemory=2048 State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
""")
    os.environ["SLURM_CONF"] = str(folder / "slurm.conf")
    daemons = [subprocess.Popen([need_program(name, "slurm-wlm"), "-D"], stdout=subprocess.DEVNULL,
                                stderr=subprocess.DEVNULL) for name in ("slurmctld", "slurmd")]
    for _ in range(100):
        if "idle" in subprocess.run(["sinfo", "-h", "-o", "%T"], capture_output=True, text=True).stdout:
            return daemons
        time.sleep(0.2)
    end(daemons)
    print("skipped: a cluster of this machine alone does not start, see slurmctld.log", flush=True)
    sys.exit(SKIPPED)


def end(daemons):
    for daemon in daemons:
        daemon.send_signal(signal.SIGTERM)
    for daemon in daemons:
        daemon.wait()


def rows(folder):
    with open(folder / "out" / "results.csv", newline="") as table:
        return list(csv.DictReader(table))


def work_on(folder):
    (folder / "bed.toml").write_text(BED)
    (folder / "sweep.toml").write_text(SWEEP)
    run(BERNAL, "sweep", "sweep.toml", "-o", "out", "--slurm", "--jobs", "2", "--time", "1m", folder=folder)
    said = run(SBATCH, "--parsable", "--wait", "out/sweep.sbatch", folder=folder)
    expect(said.strip().isdigit(), f"sbatch takes the script: job {said.strip()}")
    logs = list((folder / "out" / "slurm").iterdir())
    expect(len(logs) == 12, f"{len(logs)} logs of 12 tasks")
    run(BERNAL, "sweep", "sweep.toml", "-o", "out", "--collect", folder=folder)
    table = rows(folder)
    expect(len(table) == 12 and all(row["outcome"] == "converged" for row in table), "12 cells, all of them packed")
    # The same cells as without Slurm, bit for bit.
    run(BERNAL, "sweep", "sweep.toml", "-o", "here", folder=folder)
    with open(folder / "here" / "results.csv", newline="") as other:
        expect([row["hash"] for row in csv.DictReader(other)] == [row["hash"] for row in table],
               "the same packings as in a pool on this machine")


def by_engine(folder, name, command):
    """The first call leaves a script, which Slurm runs; what the second one says."""
    (folder / f"{name}.toml").write_text(BY_ENGINE.format(command=json.dumps(command)))
    pack = [BERNAL, "pack", f"{name}.toml", "-o", name, "--quiet"]
    first = subprocess.run(pack, cwd=folder, capture_output=True, text=True)
    expect(first.returncode == 3 and "sbatch " in first.stderr, f"{name}: what is to be submitted is said")
    run(SBATCH, "--parsable", "--wait", "--output", folder / f"{name}.log", folder / name / "engine/submit.sh", folder=folder)
    return subprocess.run(pack, cwd=folder, capture_output=True, text=True)


def work_on_engine(folder):
    if not find_program("lmp", "lammps") or not find_program("mpirun", "openmpi-bin"):
        return
    if os.geteuid() == 0:  # jobs have the environment of who submits them
        os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    done = by_engine(folder, "together", ["mpirun"])
    expect(done.returncode == 0, f"the same call goes on after the job {done.stderr}")
    run(BERNAL, "verify", "together", folder=folder)
    # Ranks that know nothing of their launcher, as where it is of another MPI than theirs: each packs everything by
    # itself. Debian's Open MPI would not start at all where Slurm's variables tell of a step that has no PMI.
    done = by_engine(folder, "alone", ["srun", "--mpi=none", "env", "-i", "PATH=/usr/bin:/bin"])
    expect(done.returncode == 3 and "did not find each other" in done.stderr, f"ranks that are alone: {done.stderr.strip()}")


def work(folder):
    folder = Path(folder)
    daemons = [] if answers("scontrol", "ping") else start_cluster(folder / "cluster")
    try:
        work_on(folder)
        work_on_engine(folder)
    finally:
        end(daemons)


in_folder(work)
