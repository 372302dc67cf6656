"""The lap through PythonFMU: one Runge-Kutta step for each communication step, in plain Python."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

M, K, C = 2.35, 10.56e5, 31.5
JOINT_K, JOINT_C, JOINT_K3 = 4.56e6, 10.0, 5e12


class LapPython(Fmi2Slave):
    def __init__(self, **arguments):
        super().__init__(**arguments)
        self.a_force = self.b_force = 0.0
        self.a_y = self.a_v = self.b_y = self.b_v = 0.0
        # value references follow from the order
        for name in ("a_force", "b_force"):
            self.register_variable(
                Real(name, causality=Fmi2Causality.input, variability=Fmi2Variability.continuous)
            )
        for name in ("a_y", "a_v", "b_y", "b_v"):
            self.register_variable(Real(name, causality=Fmi2Causality.output))

    def rate(self, a_y, a_v, b_y, b_v):
        r = a_y - b_y
        joint = JOINT_K * r + JOINT_C * (a_v - b_v) + JOINT_K3 * r * r * r
        return (
            a_v,
            (self.a_force - K * a_y - C * a_v - joint) / M,
            b_v,
            (self.b_force - K * b_y - C * b_v + joint) / M,
        )

    def do_step(self, current_time, step_size):
        h = step_size
        x = (self.a_y, self.a_v, self.b_y, self.b_v)
        k1 = self.rate(*x)
        k2 = self.rate(*(x[i] + 0.5 * h * k1[i] for i in range(4)))
        k3 = self.rate(*(x[i] + 0.5 * h * k2[i] for i in range(4)))
        k4 = self.rate(*(x[i] + h * k3[i] for i in range(4)))
        self.a_y, self.a_v, self.b_y, self.b_v = (
            x[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]) for i in range(4)
        )
        return True
