"""The launch file inside a recording may hold anything: what is no table is empty, what is no number the default."""

import pytest

from runtime.recorded_launch import number_of, specs_of


@pytest.mark.parametrize("components", [None, 3, "camera", {"name": "camera"}, [None, 3, "camera"]])
def test_what_is_no_list_of_tables_has_no_components(components):
    assert specs_of({"components": components}) == []
    assert number_of({"components": components}, "camera_up_m", 0.45) == 0.45


def test_a_component_without_tables_gets_empty_ones():
    assert specs_of({"components": [{"name": "pilot", "params": 3}]}) == [
        {"name": "pilot", "params": {}, "inputs": {}, "outputs": {}}
    ]


@pytest.mark.parametrize("value", ["1", None, [1.0], {}, float("nan"), float("inf"), -float("inf"), 10**400])
def test_a_parameter_that_is_no_finite_number_is_the_default(value):
    launch = {"components": [{"name": "simulator", "params": {"camera_up_m": value}}]}
    assert number_of(launch, "camera_up_m", 0.45) == 0.45


def test_a_parameter_is_found_in_whichever_component_has_it():
    launch = {"components": [{"name": "vision"}, {"name": "simulator", "params": {"camera_up_m": 1}}]}
    assert number_of(launch, "camera_up_m", 0.45) == 1.0
    assert number_of(launch, "edge_offset_m", 0.05) == 0.05
