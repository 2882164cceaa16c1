// The exact motion of a top in Rust, by the C interface of the kernel and without a crate.
use std::ffi::CStr;
use std::os::raw::{c_char, c_int};

#[repr(C)]
struct Start {
    moments: [f64; 3], // Ix and Iz in kg m^2, Mgl in J
    orientation: [f64; 4],
    angular_velocity: [f64; 3],
    friction: [f64; 2],
    torque: [f64; 3],
}

#[repr(C)]
struct Motion {
    _private: [u8; 0],
}

extern "C" {
    fn symtop_describe_status(status: c_int) -> *const c_char;
    fn symtop_new(start: *const Start, motion: *mut *mut Motion) -> c_int;
    fn symtop_free(motion: *mut Motion);
    fn symtop_state(motion: *mut Motion, t: f64, orientation: *mut f64, omega: *mut f64) -> c_int;
    fn symtop_find_turning_angles(motion: *mut Motion, angles: *mut f64);
}

/// A motion of the kernel, freed when it goes out of scope.
struct Top(*mut Motion);

impl Top {
    fn new(start: &Start) -> Result<Top, String> {
        let mut motion = std::ptr::null_mut();
        check(unsafe { symtop_new(start, &mut motion) }).map(|()| Top(motion))
    }

    /// w, x, y, z, and the angular velocity in the body frame.
    fn at(&self, t: f64) -> Result<([f64; 4], [f64; 3]), String> {
        let (mut q, mut omega) = ([0.0; 4], [0.0; 3]);
        let status = unsafe { symtop_state(self.0, t, q.as_mut_ptr(), omega.as_mut_ptr()) };
        check(status).map(|()| (q, omega))
    }

    fn turning_angles(&self) -> [f64; 2] {
        let mut angles = [0.0; 2];
        unsafe { symtop_find_turning_angles(self.0, angles.as_mut_ptr()) };
        angles
    }
}

impl Drop for Top {
    fn drop(&mut self) {
        unsafe { symtop_free(self.0) }
    }
}

fn check(status: c_int) -> Result<(), String> {
    if status == 0 {
        return Ok(());
    }
    let text = unsafe { CStr::from_ptr(symtop_describe_status(status)) };
    Err(text.to_string_lossy().into_owned())
}

fn main() -> Result<(), String> {
    let tilt: f64 = 0.25; // half of theta
    let top = Top::new(&Start {
        moments: [0.000228, 0.0000572, 0.068],
        orientation: [tilt.cos(), tilt.sin(), 0.0, 0.0],
        angular_velocity: [0.0, 0.0, 200.0],
        friction: [0.0; 2],
        torque: [0.0; 3],
    })?;
    let [smallest, largest] = top.turning_angles();
    println!("theta is between {:.6} and {:.6} rad", smallest, largest);
    for t in [0.0, 1.0, 1e6] {
        let (q, _) = top.at(t)?;
        println!("t = {:7} s: {:?}", t, q);
    }
    Ok(())
}
