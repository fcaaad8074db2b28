from app.services.batches import batches_of, in_batches


def test_batches_hold_all_in_order() -> None:
    for items in ([], [1], [1, 2], [1, 2, 3, 4, 5]):
        expected = [items[start : start + 2] for start in range(0, len(items), 2)]
        assert list(in_batches(items, 2)) == expected
        assert list(batches_of(iter(items), 2)) == expected


def test_no_more_is_taken_than_a_batch_holds() -> None:
    source = iter(range(10))
    assert next(batches_of(source, 3)) == [0, 1, 2]
    assert next(source) == 3
