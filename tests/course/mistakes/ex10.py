"""Mistakes of beginners in exercise 10; test_mistakes.py says what stands where."""

MISTAKES = [
    ("10.1", "z for an axis that is not named", "turns around x", "mutant default_axis_is_z"),
    ("10.2", "limits that the robot exceeds", r"should be \[.*inf", "mutant limits_of_the_chapter"),
    ("10.3", "a number of the quaternion for the angle", "quaternion", "mutant part_of_the_quaternion"),
    ("10.4", "the speed not reset", "self.speed is 7, not 0", "mutant speed_not_reset"),
    ("10.4", "the seed not used", "do not come from the seed", "mutant unseeded_start"),
    ("10.4", "another gravity", "gravity", "mutant earth_gravity"),
    ("10.5", "the action not cut", "is not cut to -1 and 1", "mutant action_not_cut"),
    ("10.6", "speed costs in one direction", r"see abs\(\)", "mutant reward_of_driving_forward"),
    ("10.6", "ends by the angle instead of the height", "terminated is True, but with the centre of the body", "mutant judged_by_the_angle"),
    ("10.7", "no limit of steps", "had 600 steps, but should have 500", "mutant no_time_limit"),
]  # fmt: skip
