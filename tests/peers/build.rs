//! Builds the CVODE peer and links SUNDIALS (Debian: libsundials-dev).

fn main() {
    println!("cargo::rerun-if-changed=cvode/peer.c");
    cc::Build::new()
        .file("cvode/peer.c")
        .opt_level(3)
        .warnings(true)
        .compile("cvode_peer");
    for library in ["sundials_cvode", "sundials_nvecserial"] {
        println!("cargo::rustc-link-lib={library}");
    }
}
