"""Where an arm's hand can go: walked from home, place by place, with the inverse kinematics that drives it."""
