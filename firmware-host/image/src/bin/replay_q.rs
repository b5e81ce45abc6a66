//! Replays a stream in fixed point: see the library's file of this name.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod image {
    use firmware_image::replay;
    use firmware_image::under_test::Fixed;

    #[cortex_m_rt::entry]
    fn main() -> ! {
        replay::run::<Fixed>()
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    firmware_image::not_for_the_host();
}
