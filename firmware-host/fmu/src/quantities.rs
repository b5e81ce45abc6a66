//! Enumerations of the units, and names of their variables.

use crate::variable::Enumeration;
use firmware_bench::scene::policy_kind::PolicyKind;
use plant_model::ContactMode;

/// What the rotor does.
pub(crate) static CONTACT: Enumeration = Enumeration {
    name: "ContactMode",
    about: "what the rotor does at its retainer bearing",
    items: &["flight", "slip+", "slip-", "roll", "seated"],
};

/// What the supervisor does.
pub(crate) static SUPERVISION: Enumeration = Enumeration {
    name: "SupervisorMode",
    about: "what the supervisor is doing",
    items: &[
        "levitated",
        "approach",
        "bounce",
        "backward whirl",
        "pinned",
        "handover",
        "sensor fault",
        "handed back",
    ],
};

/// Who drives the magnets.
pub(crate) static POLICY: Enumeration = Enumeration {
    name: "Policy",
    about: "who drives the magnets",
    items: &["passive", "radial", "damping", "levitation", "supervisor"],
};

/// Number of what the rotor does.
pub(crate) fn contact_number(mode: ContactMode) -> i64 {
    match mode {
        ContactMode::Flight => 0,
        ContactMode::SlipPositive => 1,
        ContactMode::SlipNegative => 2,
        ContactMode::Roll => 3,
        ContactMode::Seated => 4,
    }
}

pub(crate) fn policy_number(kind: PolicyKind) -> i64 {
    match kind {
        PolicyKind::Passive => 0,
        PolicyKind::Radial => 1,
        PolicyKind::Damping => 2,
        PolicyKind::Levitation => 3,
        PolicyKind::Supervisor => 4,
    }
}

/// The policy of a number.
pub(crate) fn policy(number: i64) -> Option<PolicyKind> {
    PolicyKind::ALL
        .into_iter()
        .find(|kind| policy_number(*kind) == number)
}

/// Name of a plane's variable; what has one plane says nothing of it.
pub(crate) fn of_plane(planes: usize, plane: usize, name: &str) -> String {
    match planes {
        1 => name.to_owned(),
        _ => format!("plane[{plane}].{name}"),
    }
}

/// Where a plane is named by number: the number and the rest.
pub(crate) fn split_plane(name: &str) -> (usize, &str) {
    let numbered = || {
        let (plane, rest) = name.strip_prefix("plane[")?.split_once("].")?;
        Some((plane.parse().ok()?, rest))
    };
    numbered().unwrap_or((0, name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn enumerations_have_the_names_of_what_they_number() {
        use supervisor::Mode as S;
        let contact = [
            ContactMode::Flight,
            ContactMode::SlipPositive,
            ContactMode::SlipNegative,
            ContactMode::Roll,
            ContactMode::Seated,
        ];
        for mode in contact {
            assert_eq!(CONTACT.items[contact_number(mode) as usize], mode.name());
        }
        let supervision = [
            S::Levitated,
            S::Approach,
            S::Bounce,
            S::BackwardWhirl,
            S::Pinned,
            S::Handover,
            S::SensorFault,
            S::HandedBack,
        ];
        for mode in supervision {
            assert_eq!(SUPERVISION.items[mode as usize], mode.name());
        }
        for kind in PolicyKind::ALL {
            let number = policy_number(kind);
            assert_eq!(POLICY.items[number as usize], kind.name());
            assert_eq!(policy(number), Some(kind));
        }
    }

    #[test]
    fn planes_are_told_from_keys() {
        assert_eq!(split_plane("plane[1].mass_kg"), (1, "mass_kg"));
        assert_eq!(split_plane("mass_kg"), (0, "mass_kg"));
        assert_eq!(of_plane(2, 1, "mass_kg"), "plane[1].mass_kg");
        assert_eq!(of_plane(1, 0, "mass_kg"), "mass_kg");
    }
}
