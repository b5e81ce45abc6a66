//! Counts instructions of the second half of a tick of two planes in floats: see the library's file of this name.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod image {
    use firmware_image::count;
    use firmware_image::under_test::SecondHalf;

    #[cortex_m_rt::entry]
    fn main() -> ! {
        count::run::<SecondHalf>()
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    firmware_image::not_for_the_host();
}
