//! The lap through the fmi-export runtime: one Runge–Kutta step for each communication step.

use std::ffi::c_char;

use fmi::fmi3::Fmi3Error;
use fmi_export::{
    FmuModel,
    fmi3::{CSDoStepResult, Context, DefaultLoggingCategory, Model, UserModel},
};

/// Two equal supported masses with a hardening joint.
#[derive(FmuModel, Debug, Default)]
#[model(model_exchange = false, co_simulation = true, user_model = false)]
struct Lap {
    #[variable(causality = Input, variability = Continuous, start = 0.0)]
    a_force: f64,
    #[variable(causality = Input, variability = Continuous, start = 0.0)]
    b_force: f64,
    #[variable(causality = Output, variability = Continuous, start = 0.0, initial = Exact)]
    a_y: f64,
    #[variable(causality = Output, variability = Continuous, start = 0.0, initial = Exact)]
    a_v: f64,
    #[variable(causality = Output, variability = Continuous, start = 0.0, initial = Exact)]
    b_y: f64,
    #[variable(causality = Output, variability = Continuous, start = 0.0, initial = Exact)]
    b_v: f64,
    #[variable(causality = Parameter, variability = Tunable, start = 2.35)]
    m: f64,
    #[variable(causality = Parameter, variability = Tunable, start = 10.56e5)]
    k: f64,
    #[variable(causality = Parameter, variability = Tunable, start = 31.5)]
    c: f64,
    #[variable(causality = Parameter, variability = Tunable, start = 4.56e6)]
    joint_k: f64,
    #[variable(causality = Parameter, variability = Tunable, start = 10.0)]
    joint_c: f64,
    #[variable(causality = Parameter, variability = Tunable, start = 5e12)]
    joint_k3: f64,
}

impl Lap {
    fn rate(&self, [a_y, a_v, b_y, b_v]: [f64; 4]) -> [f64; 4] {
        let r = a_y - b_y;
        let joint = self.joint_k * r + self.joint_c * (a_v - b_v) + self.joint_k3 * r * r * r;
        [
            a_v,
            (self.a_force - self.k * a_y - self.c * a_v - joint) / self.m,
            b_v,
            (self.b_force - self.k * b_y - self.c * b_v + joint) / self.m,
        ]
    }
}

impl UserModel for Lap {
    type LoggingCategory = DefaultLoggingCategory;

    fn do_step(
        &mut self,
        context: &mut dyn Context<Self>,
        current_communication_point: f64,
        communication_step_size: f64,
        _: bool,
    ) -> Result<CSDoStepResult, Fmi3Error> {
        let h = communication_step_size;
        let x = [self.a_y, self.a_v, self.b_y, self.b_v];
        let moved = |by: f64, rate: &[f64; 4]| std::array::from_fn(|i| x[i] + by * rate[i]);
        let k1 = self.rate(x);
        let k2 = self.rate(moved(0.5 * h, &k1));
        let k3 = self.rate(moved(0.5 * h, &k2));
        let k4 = self.rate(moved(h, &k3));
        [self.a_y, self.a_v, self.b_y, self.b_v] =
            std::array::from_fn(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        let end = current_communication_point + h;
        context.set_time(end);
        Ok(CSDoStepResult::completed(end))
    }
}

fmi_export::export_fmu!(Lap);

/// The token, for a driver that reads no model description.
#[unsafe(no_mangle)]
extern "C" fn peer_token() -> *const c_char {
    static TOKEN: std::sync::OnceLock<std::ffi::CString> = std::sync::OnceLock::new();
    TOKEN
        .get_or_init(|| std::ffi::CString::new(Lap::INSTANTIATION_TOKEN).unwrap_or_default())
        .as_ptr()
}
