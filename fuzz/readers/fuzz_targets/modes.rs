//! Mode shapes in a universal file: refused with a reason, or modes whose functions can be computed.
#![no_main]

use std::path::Path;

use bolted_joint_frf::structure::ModalModel;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(modes) = ModalModel::from_universal(bytes, Path::new("bytes.unv")) {
        let point = modes.points()[0];
        let _ = modes.receptance(point, point, &[0.0, 10.0]);
    }
});
