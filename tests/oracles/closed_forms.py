"""Closed forms of problems in docs/problems, in the problem's own language (used by expected_values.py).

By problem, {(table, name): expression}: an entry of the expected object as an expression in the problem's
parameters and state.
"""


def family(table, members):
    """{(table, member): expression} for one table."""
    return {(table, member): expression for member, expression in members.items()}


CLOSED_FORMS = {
    "bead_moving_floor": {
        ("multipliers", "bowl"): "m*(g + k*x'^2 - c*w^2*sin(w*t))/(1 + k^2*x^2)",
    },
    "bead_rotating_tube": {
        ("multipliers", "inner_stop"): "m*(e*k - r*(w0 + k*t)^2)",
    },
    "block_in_tight_slot": {
        ("reaction", "x"): "-F",
    },
    "cam_follower": {
        ("multipliers", "cam"): "P + k*y + m*(g - e*w^2)",
    },
    "column_heavy_top": {
        ("multipliers", "floor"): "g*((N - 1)*m + heavy)",
        **family("multipliers", {f"gap[{i}]": f"g*((N - 1 - {i})*m + heavy)" for i in range(1, 20)}),
    },
    "coupled_wheels_dead_centre": {
        **family("acceleration", {x: "(M - m*g*r)/(2*J + m*r^2)" for x in "ab"}),
        ("acceleration", "k"): "0",
    },
    "cradle_pushed": {
        ("acceleration", "a[1]"): "F/(N*m*l)",
        **family("multipliers", {f"gap[{i}]": f"F*(N - {i})/N" for i in range(1, 5)}),
    },
    "cylinder_leaving": {
        ("two_sided.multipliers", "cylinder"): "m*g*(3*y/R - 2)",
        ("acceleration", "y"): "-g",
    },
    "delassus_drops_too_little": {
        ("two_sided.multipliers", "left"): "1143/10",
        ("two_sided.multipliers", "right"): "-2457/10",
        ("multipliers", "left"): "0",
        ("multipliers", "right"): "0",
        ("acceleration", "y"): "pull/m - g",
    },
    "delassus_drops_too_much": {
        ("two_sided.multipliers", "left"): "-5",
        ("two_sided.multipliers", "right"): "-1/2",
        ("multipliers", "left"): "0",
        ("multipliers", "right"): "7/2",
    },
    "double_pendulum_stops": {
        ("multipliers", "hip_stop"): "hip - g*sin(a0)*((m1 + m2)*l1 + m2*l2)",
        ("multipliers", "knee_stop"): "knee - g*sin(a0)*m2*l2",
    },
    "elevator_emergency_stop": {
        ("multipliers", "floor"): "S - m1*(d - g)",
        ("acceleration", "y2"): "d - g",
    },
    "gear_backlash": {
        ("multipliers", "drive"): "(M1*r1/J1 + M2*r2/J2)/(r1^2/J1 + r2^2/J2)",
    },
    "groove_on_cart": {
        ("two_sided.acceleration", "X"): "F/(M + m)",
        ("acceleration", "X"): "(F - m*g*sa*ca)/(M + m*sa^2)",
        ("multipliers", "rear"): "m*(g*ca + sa*(F - m*g*sa*ca)/(M + m*sa^2))",
    },
    "ladder_leaves_wall": {
        ("two_sided.multipliers", "wall"): "m*cos(a)*(3*g*sin(a)/4 - h*a'^2)",
    },
    "ladder_slow": {
        ("acceleration", "a"): "-3*g/(4*h)*cos(a)",
        ("multipliers", "wall"): "3/4*m*g*sin(a)*cos(a)",
        ("multipliers", "floor"): "m*g*(1 - 3/4*cos(a)^2)",
    },
    "packing_in_box": {
        ("multipliers", "up_right[3]"): "2*m*g/sqrt(3)",
    },
    "sphere_in_wedge": {
        ("multipliers", "left"): "m*g*sin(b)/sin(a + b)",
        ("multipliers", "right"): "m*g*sin(a)/sin(a + b)",
    },
    "string_pendulum_slack": {
        ("two_sided.multipliers", "string"): "m*(v^2/L - 4/5*g)",
        ("acceleration", "y"): "-g",
    },
    "string_pendulum_taut": {
        ("multipliers", "string"): "m*(v^2/L + 4/5*g)",
    },
    "table_centred": family("multipliers", dict.fromkeys(
        ("front_left", "front_right", "back_right", "back_left"), "m*g/4")),
    "table_off_centre": {
        ("two_sided.multipliers", "front_right"): "m*g/4*5/2",
        ("two_sided.multipliers", "back_left"): "-m*g/8",
        ("multipliers", "front_left"): "m*g/8",
        ("multipliers", "front_right"): "3/4*m*g",
        ("multipliers", "back_left"): "0",
    },
    "trammel_stop": {
        ("multipliers", "rod"): "m2*g*L/y",
        ("multipliers", "stop"): "m2*g*x/y",
    },
    "valve_float": {
        ("acceleration", "y"): "-(P + k*y)/m",
        ("acceleration", "phi"): "0",
    },
    "violated_rule_keeps_too_little": {
        ("multipliers", "left"): "m*g/3",
        ("multipliers", "right"): "2*m*g/3",
    },
    "violated_rule_keeps_too_much": {
        ("multipliers", "left"): "3*m*g/5",
        ("multipliers", "right"): "0",
    },
    "wires_crossing": {
        ("acceleration", "x"): "0",
        ("acceleration", "y"): "2*c*x'^2",
        ("reaction", "y"): "m*(g + 2*c*x'^2)",
    },
}
