//! A small importer: writes an FMU's resources, instantiates it by either version, and keeps what it logs.

mod callbacks;
mod instance;
mod request;
mod resources;

pub(crate) use callbacks::{Message, Update, record, record_fmi2};
pub(crate) use instance::{Instance, Make, State};
pub(crate) use request::Request;
pub(crate) use resources::{Folder, Kind, start_text, text};

pub(crate) const TOKEN: &str = "{7f0c-4a} #1";

/// Value references of modelDescription/*.xml that the tests use.
pub(crate) mod vr {
    pub(crate) const TIME: u32 = 0;
    pub(crate) const A_Y: u32 = 1;
    pub(crate) const A_THETA: u32 = 2;
    pub(crate) const A_V: u32 = 3;
    pub(crate) const A_OMEGA: u32 = 4;
    pub(crate) const B_Y: u32 = 5;
    pub(crate) const B_THETA: u32 = 6;
    pub(crate) const B_V: u32 = 7;
    pub(crate) const B_OMEGA: u32 = 8;
    /// Motion of both sides.
    pub(crate) const MOTION: [u32; 8] = [A_Y, A_THETA, A_V, A_OMEGA, B_Y, B_THETA, B_V, B_OMEGA];
    pub(crate) const A_F: u32 = 9;
    pub(crate) const A_M: u32 = 10;
    pub(crate) const B_F: u32 = 11;
    pub(crate) const B_M: u32 = 12;
    pub(crate) const JOINT_F: u32 = 13;
    pub(crate) const JOINT_M: u32 = 14;
    pub(crate) const ENERGY: u32 = 15;
    pub(crate) const POWER: u32 = 16;
    pub(crate) const K_YY: u32 = 17;
    pub(crate) const C_YY: u32 = 20;
    pub(crate) const K3_Y: u32 = 23;
    pub(crate) const A_MASS: u32 = 25;
    pub(crate) const B_C_Y: u32 = 35;
    pub(crate) const STEP_SIZE_MAX: u32 = 37;
    pub(crate) const K5_Y: u32 = 42;
    pub(crate) const K7_Y: u32 = 44;
    pub(crate) const C2_Y: u32 = 46;
    pub(crate) const C4_Y: u32 = 48;
    pub(crate) const ESCAPE_Y: u32 = 50;
    pub(crate) const ESCAPE_THETA: u32 = 51;
    pub(crate) const A_ACCELERATION: u32 = 38;
    pub(crate) const A_ALPHA: u32 = 39;
    pub(crate) const B_ACCELERATION: u32 = 40;
    pub(crate) const B_ALPHA: u32 = 41;
    pub(crate) const NONE: u32 = 52;
}
