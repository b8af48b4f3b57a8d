"""Lines of CARMEN logs for tests."""


def flaser(stamp, pose, ranges, laser_pose=None):
    numbers = [*ranges, *(laser_pose or pose), *pose]
    return f"FLASER {len(ranges)} {' '.join(map(str, numbers))} {stamp:.6f} host {stamp:.6f}"


def robotlaser(stamp, pose, ranges, laser_pose, fan=(-1.5, 3.0, 0.1, 20.0), remissions=(), turn_axis=True):
    start, view, step, range_max = fan
    head = f"ROBOTLASER1 0 {start} {view} {step} {range_max} 0.01 0 {len(ranges)}"
    counted = f" {len(remissions)} {' '.join(map(str, remissions))}" if turn_axis else ""
    tail = [*laser_pose, *pose, 0.0, 0.0, 0.3, 0.2] + ([1e6] if turn_axis else [])
    return f"{head} {' '.join(map(str, ranges))}{counted} {' '.join(map(str, tail))} {stamp:.6f} host {stamp:.6f}"


def odom(stamp, pose):
    return f"ODOM {' '.join(map(str, pose))} 0 0 0 {stamp:.6f} host {stamp:.6f}"


def write(folder, *lines, name="made.clf"):
    path = folder / name
    path.write_text("\n".join(lines) + "\n")
    return path
