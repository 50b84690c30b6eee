"""Available memory: of the machine, the control group, the batch job, and the address space."""

import json
import subprocess
import sys
from pathlib import Path

import psutil
import pytest
from case_sentences import GOOD, changed

from mpmkit.case import load_case, parse_case
from mpmkit.errors import CaseError
from mpmkit.output.checkpoints import Checkpoints
from mpmkit.solver import available_memory as module
from mpmkit.solver.available_memory import available_memory
from mpmkit.solver.memory import checkpoint_bytes, require_memory
from mpmkit.solver.simulation import Simulation

CASES = Path(__file__).parents[1] / "cases"
GIB = 2**30


@pytest.fixture
def machine(monkeypatch, tmp_path):
    """A machine with 64 GiB free, and no limits but those that a test writes."""
    monkeypatch.setattr(psutil, "virtual_memory", lambda: type("Memory", (), {"available": 64 * GIB}))
    monkeypatch.setattr(module, "GROUPS", tmp_path / "groups")
    monkeypatch.setattr(module, "OWN_GROUPS", tmp_path / "own")
    for name in ("SLURM_MEM_PER_NODE", "SLURM_MEM_PER_CPU", "SLURM_CPUS_ON_NODE"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(module, "_of_address_space", lambda: iter(()))
    return tmp_path


def write(folder, **files):
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (folder / name.replace("__", ".")).write_text(f"{content}\n")


def test_without_limits_it_is_what_the_machine_has_free(machine):
    assert available_memory() == 64 * GIB


def test_a_control_group_of_version_2_and_those_around_it(machine):
    (machine / "own").write_text("0::/slurm/job_7/step_0\n")
    groups = machine / "groups"
    write(groups / "slurm/job_7/step_0", memory__max="max", memory__current=3 * GIB)
    write(groups / "slurm/job_7", memory__max=8 * GIB, memory__current=3 * GIB, memory__stat="anon 1\n")
    assert available_memory() == 5 * GIB
    write(
        groups / "slurm/job_7", memory__stat=f"anon 1\ninactive_file {GIB}\nactive_file 5"
    )  # can be dropped
    assert available_memory() == 6 * GIB
    write(groups / "slurm/job_7/step_0", memory__max=4 * GIB)
    assert available_memory() == GIB


def test_a_control_group_seen_from_within_a_container(machine):
    """Its path does not exist there; the root of what can be seen has the limit."""
    (machine / "own").write_text("0::/docker/abc\n")
    write(machine / "groups", memory__max=2 * GIB, memory__current=GIB // 2)
    assert available_memory() == 1.5 * GIB


def test_a_control_group_of_version_1(machine):
    (machine / "own").write_text("5:devices:/\n4:memory:/job\n1:cpu,cpuacct:/\n0::/\n")
    group = machine / "groups/memory"
    write(group, memory__limit_in_bytes=9223372036854771712, memory__usage_in_bytes=GIB)
    assert available_memory() == 64 * GIB
    write(group / "job", memory__limit_in_bytes=4 * GIB, memory__usage_in_bytes=GIB)
    write(group / "job", memory__stat=f"cache 5\ntotal_inactive_file {GIB // 2}")
    assert available_memory() == 3.5 * GIB


@pytest.mark.parametrize(
    "granted",
    [{"SLURM_MEM_PER_NODE": "4096"}, {"SLURM_MEM_PER_CPU": "1024", "SLURM_CPUS_ON_NODE": "4"}],
    ids=["a node", "a core"],
)
def test_what_slurm_has_granted(machine, monkeypatch, granted):
    for name, value in granted.items():
        monkeypatch.setenv(name, value)
    own = psutil.Process().memory_info().rss
    assert available_memory() == pytest.approx(4 * GIB - own, abs=GIB / 50)
    for name in granted:
        monkeypatch.setenv(name, "0")  # all that the node has
    assert available_memory() == 64 * GIB


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such limits")
def test_the_address_space_of_a_process():
    code = (
        "import resource, psutil; from mpmkit.solver.available_memory import available_memory as left;"
        "resource.setrlimit(resource.RLIMIT_AS, (psutil.Process().memory_info().vms + 2**28,) * 2);"
        "print(left())"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert int(found.stdout) == pytest.approx(2**28, rel=0.05)


def test_a_case_that_does_not_fit_into_the_job_is_refused(machine, monkeypatch):
    data = changed("grid.cell_size", 2**-11)
    require_memory(parse_case(data))
    monkeypatch.setenv("SLURM_MEM_PER_NODE", str(psutil.Process().memory_info().rss // 2**20 + 64))
    with pytest.raises(
        CaseError, match=r"GiB of memory, but 0\.06\d* GiB is left for this run by what Slurm has granted"
    ):
        require_memory(parse_case(data))


def test_the_copy_that_a_checkpoint_makes_counts(tmp_path):
    case = load_case(CASES / "slump_fast.json", ["grid.cell_size=0.005", "grid.domain.z=[0, 0.305]"])
    simulation = Simulation(case)
    simulation.advance()
    Checkpoints(tmp_path).write(1, simulation.state(), {})
    (file,) = tmp_path.glob("*.checkpoint")
    assert checkpoint_bytes(case, len(simulation.particles)) == pytest.approx(
        1.125 * file.stat().st_size, rel=0.1
    )


def test_a_case_whose_checkpoint_does_not_fit_is_refused(machine, monkeypatch):
    from mpmkit.solver.memory import expected_bytes, expected_particles

    case = parse_case(json.loads(json.dumps(GOOD)) | {"until": 0.2})
    particles = expected_particles(case)
    between = expected_bytes(case, particles) + checkpoint_bytes(case, particles) // 2
    monkeypatch.setattr(psutil, "virtual_memory", lambda: type("Memory", (), {"available": between}))
    with pytest.raises(CaseError, match="left for this run"):
        require_memory(case)
