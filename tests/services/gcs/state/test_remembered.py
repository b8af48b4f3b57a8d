"""What takes long is found out once for what it is found from."""

from services.gcs.state.remembered import Remembered


def test_it_is_found_anew_when_a_number_or_an_object_is_another():
    found, a, b = [], [1], [1]
    remembered = Remembered()

    def find(n):
        found.append(n)
        return n

    assert [remembered.of(key, lambda n=n: find(n)) for n, key in enumerate(((1, a), (1, a), (2, a), (2, b), (2, None)))] == [0, 0, 2, 3, 4]
    assert found == [0, 2, 3, 4]
