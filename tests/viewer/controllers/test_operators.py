"""Operators that stay at hand, and those that do not."""

from add_viewer.controllers.operators import OperatorStore


def test_what_belongs_to_closed_shapes_is_forgotten_and_the_rest_stays(make_torus):
    store, (one, two) = OperatorStore(), (make_torus("one"), make_torus("two"))
    flows = [store.flow(shape, "curvature", 5.0, "kernel") for shape in (one, two)]
    store.keep_only((one,))
    assert store.flow(one, "curvature", 5.0, "kernel") is flows[0]
    assert store.flow(two, "curvature", 5.0, "kernel") is not flows[1]
    store.keep_only(())
    assert [kept.values() for kept in (store._bases, store._operators, store._flows)] == [[], [], []]
