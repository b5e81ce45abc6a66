//! Links the supervisor in fixed point: see the library's file of this name.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod image {
    use firmware_image::panic_free;
    use firmware_image::under_test::Fixed;

    // SAFETY: the only symbol of this name in the image.
    #[unsafe(no_mangle)]
    extern "C" fn _start() -> ! {
        panic_free::run::<Fixed>()
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    firmware_image::not_for_the_host();
}
