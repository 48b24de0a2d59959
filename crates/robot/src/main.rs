//! The program on the robot.

fn main() {}
