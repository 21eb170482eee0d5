"""Claims about what the program of the paper needs: elastic half-spaces under surface forces, their
path, stepping, decks and results are read and built without bodies in time, layers, fits, the
theories of others, resumed sweeps and processes. Those join at the places listed here and nowhere
else."""

import re

import house

# What is beyond the paper: whole rooms, and modules of other rooms.
ROOMS = {"rates", "theory", "fit", "resume"}
MODULES = {
    # layers
    "layered_body", "layered_surface", "mesh_waves", "scene_layers", "wave_transforms",
    # bodies in time, and a fluid between them
    "running_integrals", "advected_values", "drainage", "squeeze_film_steps", "frozen_start",
    "timed_pass", "timed_record", "timed_run", "rate_groups", "rate_entries",
    # theories of others, and fits
    "theory_groups", "classical_rows", "regime_rows", "approximation_tables", "fit_group",
    "unknown_bounds", "measurement_group", "fit_rows", "fit_words", "fit_columns",
    "case_fit", "measured_fit",
    # processes
    "ranks", "forks",
}
# Hertz's theory and (11) of the paper, which give meshes their lengths.
OF_THE_PAPER = {"convex_contact"}

# Where it joins: a module of the paper, and the modules beyond that it may use.
SEAMS = {
    # the deck: one group more
    "scene": {"rate_groups", "theory_groups", "fit_group", "measurement_group"},
    "scene_groups": {
        "classical", "curve_index", "fit_request", "layered_surface", "measured_curve"},
    "scene_problem": {"layered_body", "layered_surface", "scene_layers"},
    # the body: its deformation besides that of a half-space, and a film on it
    "elastic_operator": {"mesh_waves"},
    "equilibrium": {"drainage"},
    # one kind of experiment more
    "experiment": {"timed_run"},
    "experiment_request": {"creep"},
    "experiment_result": {"timed_record"},
    # one kind of output more
    "summarise": {"approximation_tables", "classical_rows", "rate_entries", "regime_rows"},
    "reading_rows": {"maugis"},
    "case_columns": {"classical", "fit_columns"},
    "problem_numbers": {"classical", "layered_body"},
    "model_warnings": {"layered_body", "layered_surface"},
    "result_folder": {"run_identity"},
    # one kind of run more
    "simulation": {
        "approximation_tables", "classical_rows", "fit_columns", "fit_warnings", "fit_rows",
        "fit_run", "fit_words", "joint_fit", "measured_fit", "ranks",
        "run_identity"},
    "sweeps": {"case_fit", "curve_index", "forks", "joint_fit", "ranks"},
    "sweep_case": {"fit_columns"},
    "case_queue": {"fit_columns"},
    "snapin": {"ranks"},
}

# The longest chain of `use`, in modules: what a reader must know who begins at its end.
LONGEST_CHAIN = 30

# Types with a state of the bodies: a point of the path, a reported place, the position of a stepped
# experiment, the bodies at a time, and a point of the curve on which a branch on a fixed mesh ends.
# A Jacobian has the state at which it was made.
EQUILIBRIA = {"path_point_t", "place_t", "branch_point_t", "instant_t", "point_t",
              "frozen_jacobian_t"}


def is_beyond(name):
    return name not in OF_THE_PAPER and (house.room_of(name) in ROOMS or name in MODULES)


def test_the_paper_uses_what_is_beyond_it_only_at_named_seams():
    crossings = {(name, other) for name, used in house.uses().items() if not is_beyond(name)
                 for other in used if is_beyond(other)}
    seams = {(name, other) for name, others in SEAMS.items() for other in others}
    assert crossings <= seams, crossings - seams


def test_no_seam_is_listed_that_is_none():
    """A seam that a change has closed leaves the list, so that it stays closed."""
    listed = MODULES | OF_THE_PAPER | set(SEAMS)
    assert listed <= set(house.sources()), listed - set(house.sources())
    idle = {(name, other) for name, others in SEAMS.items() for other in others
            if other not in house.uses()[name]}
    assert not idle


def test_no_other_type_holds_an_equilibrium():
    found = set()
    for path in house.sources().values():
        inside = None
        for _, _, text in house.statements(path):
            if match := re.match(r"type(?:,[^:]*)?(?:\s*::)?\s+(\w+)$", text):
                inside = match[1]
            elif re.match(r"(end type|contains)\b", text):
                inside = None
            elif inside and text.startswith("type(state_t)"):
                found.add(inside)
    assert found == EQUILIBRIA


def test_the_longest_chain_of_uses_does_not_grow():
    chain = max(map(house.longest_chain, house.sources()), key=len)
    assert len(chain) <= LONGEST_CHAIN, " -> ".join(chain)
