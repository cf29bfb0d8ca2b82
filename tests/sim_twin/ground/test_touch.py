from windup.robots import load_robot
from windup.sim_twin.ground.touch import TouchWatch
from windup.sim_twin.twin import Twin


def test_feet_may_touch_and_are_not_noted() -> None:
    robot = load_robot("op3")
    twin = Twin(robot)
    watch = TouchWatch(robot, twin.model, twin.data)
    for _ in range(50):
        twin.step(1)
        watch.update()
    assert watch.touched == []


def test_what_a_lying_robot_lies_on_is_noted_once() -> None:
    robot = load_robot("op3")
    twin = Twin(robot)
    twin.lay_down(True, twin.data.qpos[7:].copy())
    watch = TouchWatch(robot, twin.model, twin.data)
    for _ in range(400):
        twin.step(1)
        watch.update()
    assert watch.touched
    assert len(watch.touched) == len(set(watch.touched))
    assert not {foot.body for foot in robot.feet} & set(watch.touched)
