"""A whole session in one process: repeatable, and moved by nothing but what base sent."""

import itertools
import math
from collections import Counter, defaultdict
from pathlib import Path

import pytest

from components.simulator.params import SUBSTEPS_HZ
from components.simulator.params import Params as World
from docking.plant import advance
from report.session import read
from runtime.contract import Event
from runtime.hosted import Hosted
from runtime.launch import load
from runtime.recording import Logged, Recording
from runtime.system import ports_of
from schemas.drive_pb2 import BaseCommand, Drive
from schemas.policy_pb2 import Policy
from schemas.session_pb2 import Journal
from schemas.trial_pb2 import Trial
from schemas.truth_pb2 import Truth
from tests.recorded_session import LAUNCH, LEARNING, TRAIN_S, record

pytestmark = pytest.mark.xdist_group("session")
SECOND_NS = 1_000_000_000


@pytest.fixture(scope="module")
def messages(twins) -> list[Logged]:
    """Everything of the learning session."""
    return list(Recording(twins.first).messages())


def of(messages: list[Logged], topic: str) -> list[Logged]:
    return [logged for logged in messages if logged.topic == topic]


def frames(messages: list[Logged], topic: str, kind: type) -> dict[int, object]:
    """First message of each frame, decoded, by capture time."""
    found: dict[int, object] = {}
    for logged in of(messages, topic):
        found.setdefault(logged.capture_ns, kind.FromString(logged.payload))
    return found


def test_two_processes_with_one_seed_make_the_same_recording_but_for_the_wall_clock(twins, messages):
    assert list(Recording(twins.second).messages()) == messages
    first, second = (Recording(file).session() for file in (twins.first, twins.second))
    assert first.pop("started") == "started for first"
    assert second.pop("started") == "started for second"
    assert first == second
    assert launch_but_for_the_file(twins.first) == launch_but_for_the_file(twins.second)


def launch_but_for_the_file(file: Path) -> dict:
    launch = Recording(file).launch()
    recorder = next(spec for spec in launch["components"] if spec["name"] == "recorder")
    assert recorder["params"].pop("file") == str(file)
    return launch


def test_another_seed_makes_another_session(twins, messages):
    ours = of(messages, "simulator/truth")
    theirs = of(list(Recording(twins.stranger).messages()), "simulator/truth")
    assert theirs[0].payload != ours[0].payload
    assert theirs[0].capture_ns == ours[0].capture_ns


def test_every_per_frame_port_says_exactly_one_thing_a_frame(messages):
    shown = [logged.capture_ns for logged in of(messages, "camera/image")]
    assert shown == [k * SECOND_NS // 8 for k in range(len(shown))]
    system = load(LAUNCH, recording=Path("none.mcap"))
    last_ns = shown[-1]  # the end may cut it off, and base says its stop in it
    for spec in system.components:
        for port, declared in ports_of(spec.run).OUTPUTS.items():
            if declared.per_frame:
                stamps = [m.capture_ns for m in of(messages, spec.outputs[port]) if m.capture_ns < last_ns]
                assert stamps == shown[:-1], spec.outputs[port]


def test_nothing_is_lost_and_every_sequence_counts_from_zero(messages):
    sequences = defaultdict(list)
    for logged in messages:
        sequences[logged.topic, logged.run].append(logged.sequence)
    assert all(found == list(range(len(found))) for found in sequences.values())


def events_of(messages: list[Logged], system, name: str, until_ns: int):
    """What a component was handed, in the journal's order."""
    spec = system.component(name)
    hosted = Hosted(spec, 1)
    by_source = {(m.run, m.sequence, m.topic): m for m in messages}
    time_ns = 0
    for batch in (Journal.FromString(m.payload) for m in of(messages, f"{name}/journal")):
        rows = zip(batch.port, batch.source_run, batch.source_sequence, batch.time_delta_ns, strict=True)
        time_ns = 0
        for port, run, sequence, delta_ns in rows:
            time_ns += delta_ns
            if time_ns > until_ns:
                return
            input_port = batch.ports[port]
            if input_port in spec.inputs:
                source = by_source[run, sequence, spec.inputs[input_port]]
                message = hosted.decode(input_port, source.payload)
                yield Event(time_ns, input_port, message, source.capture_ns, run, sequence)
            else:
                yield Event(time_ns, input_port, None, time_ns)


def truths_of_the_fold(system, events) -> list[tuple[int, Truth]]:
    simulator = Hosted(system.component("simulator"), 1)
    said = [sample for event in events for sample in simulator.handle(event)]
    return [(s.capture_ns, Truth.FromString(s.payload)) for s in said if s.key == "simulator/truth"]


FOLDED_NS = 30 * SECOND_NS


def test_the_world_follows_from_the_recorded_commands_alone(messages):
    system = load(LAUNCH, LEARNING)
    truths = truths_of_the_fold(system, events_of(messages, system, "simulator", FOLDED_NS))
    recorded = list(frames(messages, "simulator/truth", Truth).items())
    assert len(truths) == 8 * 30 + 2
    assert truths == recorded[: len(truths)]


def test_without_base_nothing_moves_though_the_pilot_drives(messages):
    system = load(LAUNCH, LEARNING)

    def mute(event: Event) -> Event:
        return event._replace(message=BaseCommand()) if event.port == "drive" else event

    truths = truths_of_the_fold(system, map(mute, events_of(messages, system, "simulator", FOLDED_NS)))
    assert len({(truth.x_m, truth.y_m, truth.heading_rad) for _, truth in truths}) == 1
    assert all(truth.v_mps == truth.omega_radps == 0.0 for _, truth in truths)
    drives = [Drive.FromString(m.payload) for m in of(messages, "pilot/drive") if m.capture_ns <= FOLDED_NS]
    assert sum(drive.engaged and drive.v_mps > 0.0 for drive in drives) > 50


def test_the_robot_s_velocity_is_what_base_sent_after_latency_and_limits(messages):
    """A slow twin of the base: latency rounded up to whole substeps, then at most so much faster a substep."""
    world, truths = World(), frames(messages, "simulator/truth", Truth)
    late = math.ceil(world.command_latency_s * SUBSTEPS_HZ)
    commands = frames(messages, "base/actuate", BaseCommand)
    before, velocity = (0.0, 0.0), [0.0, 0.0]
    step = [world.acceleration_mps2 / SUBSTEPS_HZ, world.angular_acceleration_radps2 / SUBSTEPS_HZ]
    compared = 0
    for at_ns, next_ns in itertools.pairwise(sorted(truths)):
        if next_ns > TRAIN_S * SECOND_NS or truths[next_ns].collided:
            break
        wish = (commands[at_ns].v_mps, commands[at_ns].omega_radps)
        for substep in range(SUBSTEPS_HZ // 8):
            target = before if substep < late else wish
            for axis in (0, 1):
                velocity[axis] += max(-step[axis], min(step[axis], target[axis] - velocity[axis]))
        before, compared = wish, compared + 1
        assert truths[next_ns].v_mps == pytest.approx(velocity[0], abs=1e-12)
        assert truths[next_ns].omega_radps == pytest.approx(velocity[1], abs=1e-12)
    assert compared > 200


def test_training_never_places_the_robot_and_its_path_has_no_jumps(messages):
    trials, truths = frames(messages, "pilot/trial", Trial), frames(messages, "simulator/truth", Truth)
    training = [at_ns for at_ns in sorted(trials) if trials[at_ns].phase == Trial.TRAIN]
    assert training[-1] >= (TRAIN_S - 1) * SECOND_NS
    assert not any(truths[at_ns].placed or trials[at_ns].place for at_ns in training)
    world = World()
    for before, after in itertools.pairwise(truths[at_ns] for at_ns in training):
        assert math.dist((before.x_m, before.y_m), (after.x_m, after.y_m)) <= world.speed_limit_mps / 8
    assert max(trials[at_ns].ended for at_ns in training) >= 1, "it drove back at least once"


def test_evaluation_places_the_robot_once_a_trial(messages):
    truths = frames(messages, "simulator/truth", Truth)
    assert sum(truth.placed for truth in truths.values()) == 1


def test_pose_is_the_integral_of_velocity(messages):
    truths = sorted(frames(messages, "simulator/truth", Truth).items())
    drift_m = 0.0
    for (_, before), (_, after) in itertools.pairwise(truths):
        if after.placed or after.collided:
            continue
        mean = ((before.v_mps + after.v_mps) / 2, (before.omega_radps + after.omega_radps) / 2)
        x_m, y_m, _ = advance(before.x_m, before.y_m, before.heading_rad, *mean, 0.125)
        drift_m = max(drift_m, math.dist((x_m, y_m), (after.x_m, after.y_m)))
    assert drift_m < 0.01, "a ramp within a frame is not the mean of its ends, but nearly"


def test_the_linear_law_docks_and_picks_up_as_the_truth_says(twins, messages):
    (trial,) = [trial for trial in read(twins.first).trials if trial.phase == "EVALUATE"]
    assert trial.controller == "lc"
    assert trial.docked
    assert trial.picked
    assert not trial.collided
    truths = frames(messages, "simulator/truth", Truth)
    grasping = [t for t, state in frames(messages, "pilot/trial", Trial).items() if state.mode == Trial.GRASP]
    still = next(truths[t] for t in sorted(grasping) if abs(truths[t].v_mps) < 0.005)
    assert math.hypot(still.gripper_lateral_m, still.gripper_longitudinal_m) <= 0.02
    assert abs(still.heading_rad) <= math.radians(4)
    assert any(truths[t].holding for t in grasping)


def test_policies_are_learned_and_their_versions_only_grow(messages):
    policies = [Policy.FromString(m.payload) for m in of(messages, "learner/policy")]
    versions = [policy.version for policy in policies]
    assert len(policies) >= 5
    assert versions == sorted(set(versions))
    learned = [policy.transitions for policy in policies]
    assert learned == sorted(learned)
    assert learned[-1] >= 10
    known = [sum(action < 128 for action in policy.action) for policy in policies]
    assert known[-1] > known[0]


def test_the_pilot_uses_the_policy_that_came_last(messages):
    trials = frames(messages, "pilot/trial", Trial)
    used = [trials[at_ns].policy_version for at_ns in sorted(trials) if trials[at_ns].phase == Trial.TRAIN]
    assert used == sorted(used)
    assert used[-1] > 0


def test_a_session_ends_by_itself_and_says_so_once(messages):
    assert Counter(m.topic for m in messages)["pilot/end"] == 1
    last = [BaseCommand.FromString(m.payload) for m in of(messages, "base/actuate")][-1]
    assert (last.v_mps, last.omega_radps) == (0.0, 0.0)


def test_duration_ends_a_session_in_robot_time(tmp_path):
    record(tmp_path / "short.mcap", duration_s=2.0)
    stamps = defaultdict(list)
    for logged in Recording(tmp_path / "short.mcap").messages():
        stamps[logged.topic].append(logged.capture_ns)
    assert stamps["tracker/percept"][-1] == 2 * SECOND_NS
    shown = {tuple(stamps[f"simulator/{port}"]) for port in ("head", "base", "truth")}
    assert shown == {tuple(stamps["camera/image"])}, "what was under way at the end is recorded, too"
