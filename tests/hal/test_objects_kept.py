import gc

from windup.hal.clock import objects_kept, real_time_loop


def test_what_existed_before_stays_out_of_the_collections_of_loops() -> None:
    with objects_kept():
        kept = gc.get_freeze_count()
        assert kept > 0
        for _ in range(2):
            with real_time_loop():
                assert not gc.isenabled()
            assert gc.isenabled() and gc.get_freeze_count() >= kept - 100
    assert gc.get_freeze_count() == 0


def test_a_loop_by_itself_gives_everything_back() -> None:
    with real_time_loop():
        assert gc.get_freeze_count() > 0 and not gc.isenabled()
    assert gc.get_freeze_count() == 0 and gc.isenabled()
