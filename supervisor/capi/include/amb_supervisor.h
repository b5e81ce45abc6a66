/**
 * @file amb_supervisor.h
 * Real-time supervisor that keeps a rotor on active magnetic bearings out of dry friction backward whirl
 * when it touches its retainer bearing. C99 and C++98 or later.
 *
 * An amb_supervisor serves one bearing plane, an amb_rotor both planes of one rotor. Make it once with amb_init(), then call amb_tick() at a fixed
 * rate, usually in an interrupt:
 *
 * @code
 * static amb_supervisor plane;
 * static const amb_bearing bearing = {50e-6f, 10.0f, ...};
 *
 * float config[AMB_PARAMETERS];
 * amb_code code = amb_config_for_bearing(&bearing, config, AMB_PARAMETERS);
 * config[AMB_P_RESTITUTION] = 0.5f;
 * if (code == AMB_OK) code = amb_init(&plane, sizeof plane, config, AMB_PARAMETERS);
 * if (code != AMB_OK) stop(amb_error_text(code));
 *
 * float stimulus_n[2] = {0.0f, 0.0f};
 * amb_stimulus(&plane, stimulus_n);
 * sample.levitation_n[0] = levitation_n[0] + stimulus_n[0];
 * sample.levitation_n[1] = levitation_n[1] + stimulus_n[1];
 * amb_command command;
 * amb_tick(&plane, &sample, &command);
 * amplifiers_set(command.force_n);
 * @endcode
 *
 * A static supervisor is zero at start; the text of a code names the parameter that is outside its range; all from the stimulus on
 * is of the control interrupt.
 *
 * Units are in the names: _m, _n (newton), _s, _rad_s, _m_s, _n_m (N/m), _hz. x right, y up, angles and
 * spin counter-clockwise positive.
 *
 * Every pointer may be null or misaligned: that is an error with a text, and nothing is touched. A pointer
 * to anything else than what its type says cannot be found out. Nothing is allocated, nothing is printed,
 * nothing blocks.
 *
 * Calls on a supervisor come from three sides, none of which holds another up, in whatever order they interrupt each other:
 *
 * - the tick's: amb_tick, amb_stimulus, amb_reconfigure, amb_self_test, and those of a rotor. One call at a time.
 * - one reader's, of any lower priority or on another processor: amb_next_event, amb_record_section, amb_rearm, and those of a
 *   rotor; amb_ledger_take_in and amb_ledger_take_in_plane, and all calls of an archive. One call at a time.
 * - everybody's, with a pointer to const: amb_mode, amb_report_now, amb_rotor_report_now. Any number of calls at a time.
 *
 * A call that interrupts another one of its own side is refused with AMB_ERROR_BUSY: a tick only by a tick or a
 * reconfiguration that it interrupts. amb_init has the memory for itself. Calls on the same watch must not interrupt each
 * other (AMB_ERROR_WATCH_BUSY). Calls with neither in their arguments may come from anywhere.
 */
#ifndef AMB_SUPERVISOR_H
#define AMB_SUPERVISOR_H

#include <stddef.h>
#include <stdint.h>

/** Version of the interface that this header describes. */
#define AMB_ABI 6

/* Written beside the library when that is built; give its folder to the compiler with -I. */
#include "amb_supervisor_abi.h"
#if !defined(AMB_LIBRARY_ABI) || AMB_LIBRARY_ABI != AMB_ABI
#error "amb_supervisor.h and the library are of different versions: take both from the same source"
#endif

/* Names in the library end with the version, so that objects compiled against another one do not link. */
#define AMB_JOINED(name, abi) name##_abi##abi
#define AMB_JOIN(name, abi) AMB_JOINED(name, abi)
#define amb_error_text AMB_JOIN(amb_error_text, AMB_ABI)
#define amb_parameter_at AMB_JOIN(amb_parameter_at, AMB_ABI)
#define amb_parameter_index AMB_JOIN(amb_parameter_index, AMB_ABI)
#define amb_config_for_bearing AMB_JOIN(amb_config_for_bearing, AMB_ABI)
#define amb_config_for_rotor AMB_JOIN(amb_config_for_rotor, AMB_ABI)
#define amb_init AMB_JOIN(amb_init, AMB_ABI)
#define amb_self_test AMB_JOIN(amb_self_test, AMB_ABI)
#define amb_reconfigure AMB_JOIN(amb_reconfigure, AMB_ABI)
#define amb_tick AMB_JOIN(amb_tick, AMB_ABI)
#define amb_stimulus AMB_JOIN(amb_stimulus, AMB_ABI)
#define amb_mode AMB_JOIN(amb_mode, AMB_ABI)
#define amb_mode_name AMB_JOIN(amb_mode_name, AMB_ABI)
#define amb_report_now AMB_JOIN(amb_report_now, AMB_ABI)
#define amb_next_event AMB_JOIN(amb_next_event, AMB_ABI)
#define amb_record_section AMB_JOIN(amb_record_section, AMB_ABI)
#define amb_rearm AMB_JOIN(amb_rearm, AMB_ABI)
#define amb_rotor_init AMB_JOIN(amb_rotor_init, AMB_ABI)
#define amb_rotor_self_test AMB_JOIN(amb_rotor_self_test, AMB_ABI)
#define amb_rotor_reconfigure AMB_JOIN(amb_rotor_reconfigure, AMB_ABI)
#define amb_rotor_tick AMB_JOIN(amb_rotor_tick, AMB_ABI)
#define amb_rotor_tick_first AMB_JOIN(amb_rotor_tick_first, AMB_ABI)
#define amb_rotor_tick_second AMB_JOIN(amb_rotor_tick_second, AMB_ABI)
#define amb_rotor_stimulus AMB_JOIN(amb_rotor_stimulus, AMB_ABI)
#define amb_rotor_report_now AMB_JOIN(amb_rotor_report_now, AMB_ABI)
#define amb_rotor_next_event AMB_JOIN(amb_rotor_next_event, AMB_ABI)
#define amb_rotor_record_section AMB_JOIN(amb_rotor_record_section, AMB_ABI)
#define amb_rotor_rearm AMB_JOIN(amb_rotor_rearm, AMB_ABI)
#define amb_watch_init AMB_JOIN(amb_watch_init, AMB_ABI)
#define amb_watch_renew AMB_JOIN(amb_watch_renew, AMB_ABI)
#define amb_watch_force AMB_JOIN(amb_watch_force, AMB_ABI)
#define amb_watch_expired AMB_JOIN(amb_watch_expired, AMB_ABI)
#define amb_ledger_new AMB_JOIN(amb_ledger_new, AMB_ABI)
#define amb_ledger_read AMB_JOIN(amb_ledger_read, AMB_ABI)
#define amb_ledger_newer AMB_JOIN(amb_ledger_newer, AMB_ABI)
#define amb_ledger_take_in AMB_JOIN(amb_ledger_take_in, AMB_ABI)
#define amb_ledger_take_in_plane AMB_JOIN(amb_ledger_take_in_plane, AMB_ABI)
#define amb_ledger_write AMB_JOIN(amb_ledger_write, AMB_ABI)
#define amb_ledger_landings_left AMB_JOIN(amb_ledger_landings_left, AMB_ABI)
#define amb_archive_init AMB_JOIN(amb_archive_init, AMB_ABI)
#define amb_archive_take AMB_JOIN(amb_archive_take, AMB_ABI)
#define amb_archive_take_rotor AMB_JOIN(amb_archive_take_rotor, AMB_ABI)
#define amb_archive_count AMB_JOIN(amb_archive_count, AMB_ABI)
#define amb_archive_section AMB_JOIN(amb_archive_section, AMB_ABI)
#define amb_archive_discard AMB_JOIN(amb_archive_discard, AMB_ABI)

/* What is true when this compiles, whatever the language. */
#if defined(__cplusplus) && __cplusplus >= 201103L
#define AMB_ASSERT(name, condition) static_assert(condition, #name)
#elif !defined(__cplusplus) && defined(__STDC_VERSION__) && __STDC_VERSION__ >= 201112L
#define AMB_ASSERT(name, condition) _Static_assert(condition, #name)
#else
#define AMB_ASSERT(name, condition) typedef char amb_assert_##name[(condition) ? 1 : -1]
#endif

#ifdef __cplusplus
extern "C" {
#endif

/**
 * @name Codes
 * What a call returns. AMB_OK, AMB_NOTHING and AMB_ONE_COPY are no errors, negative codes are; amb_error_text() says
 * what they mean.
 * @{
 */
typedef int32_t amb_code;
#define AMB_OK 0 /**< done */
#define AMB_NOTHING 1 /**< there is none */
#define AMB_ONE_COPY 2 /**< one of the two copies is not whole: the last landing may be missing */
#define AMB_ERROR_SUPERVISOR_NULL (-1) /**< supervisor is null */
#define AMB_ERROR_SUPERVISOR_MISALIGNED (-2) /**< supervisor is not aligned to AMB_SUPERVISOR_ALIGN bytes */
#define AMB_ERROR_SUPERVISOR_TOO_SMALL (-3) /**< supervisor has fewer than AMB_SUPERVISOR_BYTES bytes */
#define AMB_ERROR_NOT_INITIALISED (-4) /**< supervisor was not made by amb_init */
#define AMB_ERROR_BUSY (-5) /**< supervisor is in use by a call that this one interrupted */
#define AMB_ERROR_VALUES_NULL (-6) /**< values is null */
#define AMB_ERROR_VALUES_MISALIGNED (-7) /**< values is not aligned as a float */
#define AMB_ERROR_VALUES_COUNT (-8) /**< values has not AMB_PARAMETERS elements for each plane */
#define AMB_ERROR_SAMPLE_NULL (-9) /**< sample is null */
#define AMB_ERROR_SAMPLE_MISALIGNED (-10) /**< sample is not aligned to 4 bytes */
#define AMB_ERROR_COMMAND_NULL (-11) /**< command is null */
#define AMB_ERROR_COMMAND_MISALIGNED (-12) /**< command is not aligned to 4 bytes */
#define AMB_ERROR_NAME_NULL (-13) /**< name is null */
#define AMB_ERROR_NAME_UNKNOWN (-14) /**< no parameter has this name */
#define AMB_ERROR_INDEX (-15) /**< index is beyond the end */
#define AMB_ERROR_STAMP_NULL (-16) /**< stamp is null */
#define AMB_ERROR_STAMP_MISALIGNED (-17) /**< stamp is not aligned to 4 bytes */
#define AMB_ERROR_RESULT_NULL (-18) /**< the pointer to the result is null */
#define AMB_ERROR_RESULT_MISALIGNED (-19) /**< the pointer to the result is not aligned as its type */
#define AMB_ERROR_WATCH_NULL (-20) /**< watch is null */
#define AMB_ERROR_WATCH_MISALIGNED (-21) /**< watch is not aligned to AMB_WATCH_ALIGN bytes */
#define AMB_ERROR_WATCH_NOT_INITIALISED (-22) /**< watch was not made by amb_watch_init */
#define AMB_ERROR_WATCH_BUSY (-23) /**< watch is in use by a call that this one interrupted */
#define AMB_ERROR_FORCE_NULL (-24) /**< force is null */
#define AMB_ERROR_FORCE_MISALIGNED (-25) /**< force is not aligned as a float */
#define AMB_ERROR_SELF_TEST (-26) /**< this processor, compiler or memory computes something else */
#define AMB_ERROR_ROTOR_NULL (-27) /**< rotor is null */
#define AMB_ERROR_ROTOR_MISALIGNED (-28) /**< rotor is not aligned to AMB_SUPERVISOR_ALIGN bytes */
#define AMB_ERROR_ROTOR_TOO_SMALL (-29) /**< rotor has fewer than AMB_ROTOR_BYTES bytes */
#define AMB_ERROR_ROTOR_NOT_INITIALISED (-30) /**< rotor was not made by amb_rotor_init */
#define AMB_ERROR_ROTOR_BUSY (-31) /**< rotor is in use by a call that this one interrupted */
#define AMB_ERROR_SHAFT_NULL (-32) /**< shaft is null */
#define AMB_ERROR_SHAFT_MISALIGNED (-33) /**< shaft is not aligned as a float */
#define AMB_ERROR_SHAFT_INERTIA (-34) /**< mass and transverse inertia must be above 0, the polar one from 0 to twice the transverse one */
#define AMB_ERROR_SHAFT_PLACES (-35) /**< positions must be numbers, those of the retainer bearings must differ, and none be far beyond them */
#define AMB_ERROR_PLANE (-36) /**< plane is neither 0 nor 1 */
#define AMB_ERROR_BEARING_NULL (-37) /**< bearing is null */
#define AMB_ERROR_BEARING_MISALIGNED (-38) /**< bearing is not aligned as a float */
#define AMB_ERROR_LEDGER_NULL (-39) /**< ledger is null */
#define AMB_ERROR_LEDGER_MISALIGNED (-40) /**< ledger is not aligned to 4 bytes */
#define AMB_ERROR_BYTES_NULL (-41) /**< bytes is null */
#define AMB_ERROR_LEDGER_LENGTH (-42) /**< a ledger has AMB_LEDGER_BYTES bytes */
#define AMB_ERROR_LEDGER_BLANK (-43) /**< nothing was ever written there: the ledger is lost, or was never made */
#define AMB_ERROR_LEDGER_LETTERS (-44) /**< no ledger begins there */
#define AMB_ERROR_LEDGER_DAMAGED (-45) /**< the ledger is damaged: its checksum is another one */
#define AMB_ERROR_LEDGER_VERSION (-46) /**< the ledger is of another version */
#define AMB_ERROR_LEDGER_BEARINGS (-47) /**< the copies are of two bearings */
#define AMB_ERROR_ARCHIVE_NULL (-48) /**< archive is null */
#define AMB_ERROR_ARCHIVE_MISALIGNED (-49) /**< archive is not aligned to AMB_SUPERVISOR_ALIGN bytes */
#define AMB_ERROR_ARCHIVE_NOT_INITIALISED (-50) /**< archive was not made by amb_archive_init */
#define AMB_ERROR_ARCHIVE_BUSY (-51) /**< archive is in use by a call that this one interrupted, or is there twice */
#define AMB_ERROR_PLACES_NULL (-52) /**< places is null */
#define AMB_ERROR_PLACES_MISALIGNED (-53) /**< places are not aligned to AMB_SUPERVISOR_ALIGN bytes */
#define AMB_ERROR_PLACES_COUNT (-54) /**< an archive has a place at least, and no more than there can be */
#define AMB_ERROR_ROTOR_HALF (-55) /**< the first plane has not had its half of the tick */
/** The parameter of this index is outside its range; in a rotor's second plane its index is AMB_PARAMETERS more. */
#define AMB_ERROR_PARAMETER(index) (-1000 - (amb_code)(index))
/**
 * Two parameters, each in its range, contradict each other; in a rotor's second plane the number is 6 more. Rules are
 * 0: sample_period_s and force_max_n (with mass_kg and clearance_m), 1: sensor_step_m and observer_pole_flight,
 * 2: sensor_step_m and observer_pole_contact, 3: axis_force_max_n and force_max_n, 4: force_slew_n_s and force_max_n,
 * 5: contact_band and sensor_step_m.
 */
#define AMB_ERROR_RULE(rule) (-2000 - (amb_code)(rule))
/** @} */

/**
 * @name Parameters
 * Indexes into the values that amb_init() takes, with unit and range. A parameter that is left out is 0,
 * which is outside the range of most.
 * @{
 */
#define AMB_P_SAMPLE_PERIOD_S 0 /**< s, 1e-6 to 0.01: Period of the tick. */
#define AMB_P_MASS_KG 1 /**< kg, 1e-4 to 1e6: Mass of the rotor that this bearing plane carries. */
#define AMB_P_STIFFNESS_N_M 2 /**< N/m, -1e10 to 1e10: Shaft stiffness plus the magnets' negative stiffness, either sign. */
#define AMB_P_DAMPING_N_S_M 3 /**< N s/m, 0 to 1e8: Passive damping of the rotor in flight. */
#define AMB_P_CLEARANCE_M 4 /**< m, 1e-6 to 0.1: Radial clearance of the retainer bearing. */
#define AMB_P_FORCE_MAX_N 5 /**< N, 0.001 to 1e7: Force cap of the magnet, as the length of the vector. */
#define AMB_P_AMPLIFIER_LAG_S 6 /**< s, 0 to 0.1: Time constant of the amplifier with the magnet. */
#define AMB_P_DELAY_SAMPLES 7 /**< ticks, 0 to 7: Ticks between a sample and the start of the force computed from it; rounded to whole ticks. */
#define AMB_P_FRICTION_COEFFICIENT 8 /**< 1, 0 to 2: Coefficient of friction on the retainer bearing; choose the upper end of what is likely. */
#define AMB_P_RESTITUTION 9 /**< 1, 0 to 0.99: Restitution of a radial impact on the retainer bearing. */
#define AMB_P_OBSERVER_POLE_FLIGHT 10 /**< 1, 0 to 0.98: Pole of the observer in flight: nearer to 1 smooths sensor noise more and follows later. */
#define AMB_P_OBSERVER_POLE_CONTACT 11 /**< 1, 0 to 0.98: Pole of the observer in contact, where the model knows nothing of the contact force. */
#define AMB_P_CONTACT_BAND 12 /**< clearance, 0.001 to 0.3: The rotor counts as touching within this band below the clearance; at least the retainer's offset and three times the sensor noise. */
#define AMB_P_POSITION_LIMIT 13 /**< clearance, 1.1 to 20: A measured radius beyond this is refused as implausible. */
#define AMB_P_WHIRL_TIME_S 14 /**< s, 1e-5 to 0.1: Contact that lasts this long is whirl or rest, not a bounce: some periods of the rotor on the contact stiffness. */
#define AMB_P_HOLD_SHARE 15 /**< 1, 0.1 to 0.95: Share of the cap that pushes inwards on the bearing: at most in an impact, and at first at rest, where it grows. */
#define AMB_P_HANDOVER_DWELL_S 16 /**< s, 0 to 1: Contact must be avoidable for this long before hand-over begins. */
#define AMB_P_HANDOVER_BLEND_S 17 /**< s, 0 to 1: Time of the blend to the levitation controller. */
#define AMB_P_FAULT_BLEND_S 18 /**< s, 0 to 1: Time in which the force goes to zero when the position cannot be trusted; of a levitated rotor, or along one coordinate alone, no longer than handover_blend_s. */
#define AMB_P_FAULT_TICKS 19 /**< ticks, 2 to 1e4: Good samples in a row that end a sensor fault, and refused ones that make it; jumps, dropouts and a stuck sensor make it sooner. */
#define AMB_P_AXIS_FORCE_MAX_N 20 /**< N, 0.001 to 1e7: Force cap of each axis; none where it is at least force_max_n. */
#define AMB_P_FORCE_SLEW_N_S 21 /**< N/s, 1 to 1e12: Fastest change of the commanded force, as the length of the vector. */
#define AMB_P_CONTINUOUS_FORCE_N 22 /**< N, 0.001 to 1e7: Force that the magnet bears for ever; at least force_max_n means no budget. */
#define AMB_P_THERMAL_TIME_S 23 /**< s, 0.01 to 1e5: Time constant of the force-time budget. */
#define AMB_P_CONTACT_STIFFNESS_N_M 24 /**< N/m, 1000 to 1e13: Stiffness of the contact with the retainer bearing. */
#define AMB_P_COAST_DOWN_S 25 /**< s, 0 to 100: Whirl beyond what the cap can arrest for this long asks for coasting down. */
#define AMB_P_SEVERITY_LIMIT 26 /**< 1, 0.001 to 1e8: Severity index that asks for coasting down. */
#define AMB_P_RETAINER_PLANE_RATIO 27 /**< 1, 0.2 to 5: Position at the retainer bearing over position at the sensor. */
#define AMB_P_MAGNET_PLANE_RATIO 28 /**< 1, 0.2 to 5: Position at the magnet over position at the retainer bearing: the leverage of its force. */
#define AMB_P_SPEED_MAX_M_S 29 /**< m/s, 0.001 to 1000: No rotor is faster than this at the retainer bearing: a sample that would need it is refused. */
#define AMB_P_SENSOR_STEP_M 30 /**< m, 1e-9 to 0.001: Step of the sensor's converter or its noise (root mean square), whichever is larger, at the sensor. */
#define AMB_P_BENDING_FIRST_HZ 31 /**< Hz, 0 to 1e5: Natural frequency of a bending mode that the force would drive, the lower end of what is likely; 0 where there is none. */
#define AMB_P_BENDING_SECOND_HZ 32 /**< Hz, 0 to 1e5: The same of a second mode; 0 where there is none. */
#define AMB_P_ACTS_IN_FLIGHT 33 /**< 1, 0 to 1: 1: the supervisor acts from the approach on; 0: levitation keeps the rotor in the air, and the supervisor acts on evident backward whirl alone, for shafts whose bending its force would drive. */
#define AMB_P_CHECK_FIRST 34 /**< 1, 0 to 1: 1: the supervisor only watches, as with `SHADOW`, until the machine has confirmed its configuration by levitating with the stimulus; 0: it acts unchecked, for firmware that knows better. */
/** How many there are. */
#define AMB_PARAMETERS 35
/** @} */

/** @name Status bits of a sample @{ */
#define AMB_STATUS_SPIN_VALID 0x1u    /**< spin_rad_s is measured */
#define AMB_STATUS_BEARING_ON 0x2u    /**< the bearing is on and may act; without it the supervisor never acts */
#define AMB_STATUS_APPLIED_VALID 0x4u /**< applied_n is measured */
#define AMB_STATUS_AXIS_X_LOST 0x8u   /**< the drive cannot act along x */
#define AMB_STATUS_AXIS_Y_LOST 0x10u  /**< the drive cannot act along y */
#define AMB_STATUS_LATE 0x20u         /**< the last command came too late for its tick: the actuator kept the one before */
#define AMB_STATUS_SHADOW 0x40u       /**< compute and record, but let the levitation command through, within the limits */
#define AMB_STATUS_SET_DOWN 0x80u     /**< the rotor is to be set down, or lifted: the supervisor acts on backward whirl alone */
#define AMB_STATUS_LEVITATED_BEFORE 0x100u /**< the rotor levitated until now: readings are acted on from the first sample on */
/** @} */

/** @name Modes @{ */
#define AMB_MODE_LEVITATED 0u      /**< the levitation command goes through bit for bit, within the limits and along axes that act; but
                                        for that of a sample that cannot be */
#define AMB_MODE_APPROACH 1u       /**< contact can no longer be avoided */
#define AMB_MODE_BOUNCE 2u         /**< touching and leaving again */
#define AMB_MODE_BACKWARD_WHIRL 3u /**< continuous backward whirl: braking */
#define AMB_MODE_PINNED 4u         /**< held on the bearing by a load */
#define AMB_MODE_HANDOVER 5u       /**< blending over to the levitation controller */
#define AMB_MODE_SENSOR_FAULT 6u   /**< no trustworthy position: the force goes to zero, or along one coordinate only */
#define AMB_MODE_HANDED_BACK 7u    /**< given up for a while: the levitation controller has the bearing, whatever the rotor does */
/** @} */

/** @name Hints for the levitation controller's integrator @{ */
#define AMB_INTEGRATOR_RUN 0u  /**< integrate as usual */
#define AMB_INTEGRATOR_HOLD 1u /**< keep its value; never reset it */
/** @} */

/** @name Limits: what binds the command of this tick @{ */
#define AMB_LIMIT_FORCE_CAP 0x1u           /**< more was wanted than the cap */
#define AMB_LIMIT_LEVITATION_CLAMPED 0x2u  /**< the levitation command was beyond a limit or no number */
#define AMB_LIMIT_NOT_FINITE 0x4u          /**< something was no number: the force goes to zero */
#define AMB_LIMIT_SAMPLE_REFUSED 0x8u      /**< the sample was not used */
#define AMB_LIMIT_SLEW 0x10u               /**< the slew limit binds */
#define AMB_LIMIT_AXIS_CAP 0x20u           /**< an axis had less than was wanted */
#define AMB_LIMIT_DERATED 0x40u            /**< the cap that bound was lowered by the force-time budget */
#define AMB_LIMIT_BEYOND_WHIRL_LIMIT 0x80u /**< whirl faster than the cap can arrest */
/** @} */

/** @name Events: what changed at this tick @{ */
#define AMB_EVENT_ENGAGED 0x1u           /**< the supervisor took over */
#define AMB_EVENT_TOUCHED 0x2u           /**< the rotor touched the retainer bearing */
#define AMB_EVENT_LIFTED_OFF 0x4u        /**< and left it */
#define AMB_EVENT_WHIRL 0x8u             /**< continuous backward whirl was recognised */
#define AMB_EVENT_PINNED 0x10u           /**< the rotor is held on the bearing by a load */
#define AMB_EVENT_HANDOVER 0x20u         /**< hand-over to the levitation controller began */
#define AMB_EVENT_LEVITATED 0x40u        /**< the levitation controller has the bearing again */
#define AMB_EVENT_SENSOR_FAULT 0x80u     /**< samples were implausible for too long */
#define AMB_EVENT_SENSOR_OK 0x100u       /**< they are plausible again */
#define AMB_EVENT_SEQUENCE 0x200u        /**< a sequence number was missed or repeated */
#define AMB_EVENT_LATE 0x400u            /**< the last command came too late */
#define AMB_EVENT_RECONFIGURED 0x800u    /**< from this tick on another configuration holds */
#define AMB_EVENT_AXIS_LOST 0x1000u      /**< the drive has lost an axis, or does not obey on it */
#define AMB_EVENT_AXIS_BACK 0x2000u      /**< an axis is back */
#define AMB_EVENT_COAST_DOWN 0x4000u     /**< the machine should coast down */
#define AMB_EVENT_FORWARD_RUB 0x8000u    /**< forward rub at the spin's rate was recognised */
#define AMB_EVENT_RECORD_FROZEN 0x10000u /**< there is a record to be read */
#define AMB_EVENT_QUEUE_FULL 0x20000u    /**< an event before this one was lost; only in the queue */
#define AMB_EVENT_HANDED_BACK 0x40000u   /**< an engagement made no progress: the levitation controller has the bearing */
/** @} */

/** @name What the check of the configuration has come to, see amb_stimulus(); from 3 on the machine contradicts @{ */
#define AMB_FINDING_UNCHECKED 0u      /**< nobody has asked for a check: AMB_P_CHECK_FIRST is 0 */
#define AMB_FINDING_NOT_YET 1u        /**< not enough has been seen, or no stimulus came through */
#define AMB_FINDING_PASSED 2u         /**< nothing contradicts: the supervisor may act */
#define AMB_FINDING_AXES_SWAPPED 3u   /**< x and y of sensor or force are exchanged */
#define AMB_FINDING_AXIS_INVERTED 4u  /**< one axis of sensor or force is inverted */
#define AMB_FINDING_FORCE_INVERTED 5u /**< force and position have opposite signs */
#define AMB_FINDING_AXES_TURNED 6u    /**< the axes of force and sensor are turned against each other, by the value in rad */
#define AMB_FINDING_AXES_SKEWED 7u    /**< axes not at right angles, or gains that differ; their cosine, or ratio */
#define AMB_FINDING_GAIN 8u           /**< the rotor is moved the value times as much as configured: mass, unit or gain, period, ratio of planes */
#define AMB_FINDING_DELAY 9u          /**< the force comes the value in ticks later than configured: delay or lag */
#define AMB_FINDING_NO_ANSWER 10u     /**< the rotor does not answer to the force; share of its motion that is not explained */
#define AMB_FINDING_SPIN_REVERSED 11u /**< the orbit of the unbalance goes round against the spin, which is not believed any more */
#define AMB_FINDING_SPIN_UNIT 12u     /**< the orbit goes round at the spin times 2 pi / 60: revolutions a minute for rad/s */
#define AMB_FINDING_CLEARANCE 13u     /**< a rotor at rest without force lies at the value, in clearances, from the centre */
#define AMB_FINDING_POSITION 14u      /**< levitated, the rotor is read at the value, in clearances, and more from the centre */
/** @} */

/** @name Why a sample was refused @{ */
#define AMB_REFUSAL_NONE 0u       /**< it was not */
#define AMB_REFUSAL_NOT_FINITE 1u /**< a coordinate is no number */
#define AMB_REFUSAL_RANGE 2u      /**< the radius is beyond position_limit */
#define AMB_REFUSAL_SLEW 3u       /**< no rotor moves so far in this time */
#define AMB_REFUSAL_DROPOUT 4u    /**< the sequence number is the last one */
#define AMB_REFUSAL_STUCK 5u      /**< a coordinate does not change although the rotor moves */
#define AMB_REFUSAL_DOUBTED 6u    /**< far from where the rotor was bound to, and from the sample before */
/** @} */

/** Bytes of an amb_supervisor; some more than the library needs. */
#define AMB_SUPERVISOR_BYTES 29184
/** Its alignment in bytes. */
#define AMB_SUPERVISOR_ALIGN 8

/**
 * A supervisor: memory of the caller's with nothing in it to look at. Make it static (then it is zero at
 * start), or fill it with zeros, before amb_init(). It stays where it was made: a copy of it is no supervisor
 * (AMB_ERROR_NOT_INITIALISED). It needs no clean-up.
 */
typedef union amb_supervisor {
    uint8_t bytes[AMB_SUPERVISOR_BYTES];
    uint64_t align;
} amb_supervisor;

/** Bytes of an amb_rotor. */
#define AMB_ROTOR_BYTES 58368

/** A supervisor of a rotor in two bearing planes. Opaque and static, or zero, as an amb_supervisor. */
typedef union amb_rotor {
    uint8_t bytes[AMB_ROTOR_BYTES];
    uint64_t align;
} amb_rotor;

/** What cannot be guessed of a bearing plane; all other parameters follow from it with amb_config_for_bearing(). The ranges are
 * those of the parameters of the same names. */
typedef struct amb_bearing {
    float sample_period_s;       /**< period of the tick [s] */
    float mass_kg;               /**< mass of the rotor that this plane carries [kg] */
    float stiffness_n_m;         /**< shaft stiffness plus the magnets' negative stiffness, either sign [N/m] */
    float clearance_m;           /**< radial clearance of the retainer bearing [m] */
    float force_max_n;           /**< force cap of the magnet, as the length of the vector [N] */
    float amplifier_lag_s;       /**< time constant of the amplifier with the magnet [s] */
    float friction_coefficient;  /**< friction on the retainer bearing, the upper end of what is likely */
    float contact_stiffness_n_m; /**< stiffness of the contact with the retainer bearing [N/m] */
    float sensor_noise_m;        /**< noise of the sensor (root mean square) or step of its converter, whichever is larger [m]:
                                      0 to 0.001, and at most 7 % of the clearance */
} amb_bearing;

/** A rigid rotor. Positions are along its axis from the centre of mass, first those of plane 0, and have a sign. */
typedef struct amb_shaft {
    float mass_kg;                  /**< mass [kg], > 0 */
    float transverse_inertia_kg_m2; /**< transverse moment of inertia about the centre of mass [kg m^2], > 0 */
    float polar_inertia_kg_m2;      /**< polar moment of inertia [kg m^2], 0 to twice the transverse one. Where
                                         nutation, its share of the transverse one times the spin, turns by more than
                                         1.25 rad in one and a half sample periods, delay and lag, the supervisor acts
                                         on backward whirl alone */
    float retainer_m[2];            /**< retainer bearings [m] */
    float sensor_m[2];              /**< sensors [m] */
    float magnet_m[2];              /**< magnets [m] */
} amb_shaft;

/** Bytes of an amb_archive_place. */
#define AMB_ARCHIVE_PLACE_BYTES 27096

/** Room for the record of one event of one plane. Opaque and aligned as an amb_supervisor. */
typedef union amb_archive_place {
    uint8_t bytes[AMB_ARCHIVE_PLACE_BYTES];
    uint64_t align;
} amb_archive_place;

/** Bytes of an amb_archive. */
#define AMB_ARCHIVE_BYTES 64

/**
 * Records of several events of one plane, in as many places as the caller has. The oldest goes where one more comes, and is
 * counted. Opaque and static, or zero, as an amb_supervisor; it stays where it was made, and so do its places.
 */
typedef union amb_archive {
    uint8_t bytes[AMB_ARCHIVE_BYTES];
    uint64_t align;
} amb_archive;

/** Bytes of an amb_watch. */
#define AMB_WATCH_BYTES 32
/** Its alignment in bytes. */
#define AMB_WATCH_ALIGN 4

/**
 * An output watch: holds the last command for the actuator's own loop, and lets it expire. Opaque and
 * static, or zero, as an amb_supervisor.
 */
typedef union amb_watch {
    uint8_t bytes[AMB_WATCH_BYTES];
    uint32_t align;
} amb_watch;

/** What the firmware knows at one sampling instant. Any bits are allowed: what is implausible is refused. */
typedef struct amb_sample {
    uint32_t sequence;     /**< counts up by one each tick, wrapping; the old one means: no new sample */
    uint32_t status;       /**< AMB_STATUS_ bits */
    float position_m[2];   /**< rotor at the sensor, from the centre of the retainer bearing, x and y [m] */
    float spin_rad_s;      /**< spin [rad/s]; used with AMB_STATUS_SPIN_VALID */
    float levitation_n[2]; /**< force that the levitation controller wants [N] */
    float applied_n[2];    /**< what the actuator delivers now of the commanded force [N], without what the firmware adds to
                              it; used with AMB_STATUS_APPLIED_VALID */
} amb_sample;

/** What to do until the next tick. */
typedef struct amb_command {
    float force_n[2];    /**< force to command [N]: finite and within all limits; where amb_reconfigure() has
                              lowered a cap, it is cut to that at once, and the slew limit holds from there */
    float own_n[2];      /**< force that the supervisor would command [N]: force_n but with AMB_STATUS_SHADOW */
    float severity;      /**< backward speed to come, over what the cap can arrest; 0 to 1e6 */
    uint32_t mode;       /**< AMB_MODE_ */
    uint32_t limits;     /**< AMB_LIMIT_ bits */
    uint32_t events;     /**< AMB_EVENT_ bits */
    uint32_t integrator; /**< AMB_INTEGRATOR_ */
} amb_command;

/** What to do at both ends of a rotor until the next tick. */
typedef struct amb_rotor_command {
    amb_command planes[2];     /**< each plane its own */
    uint32_t other_engaged[2]; /**< 1 for a plane if the other has engaged since the records were read: hold back what would
                                    disturb now (excitation, a set-down, a reconfiguration) */
    uint32_t coast_down;       /**< 1 once a plane has asked for coasting down, until amb_rotor_init() */
} amb_rotor_command;

/** An event with its tick. */
typedef struct amb_event {
    uint32_t sequence; /**< sequence number of the sample */
    uint32_t mode;     /**< AMB_MODE_ after the tick */
    uint32_t events;   /**< AMB_EVENT_ bits */
} amb_event;

/** Version of the format of a flight record. */
#define AMB_RECORD_VERSION 4
/** Most ticks of a record, a quarter of them from before the supervisor engaged. */
#define AMB_RECORD_ENTRIES 512

/** What firmware adds to a flight record. */
typedef struct amb_stamp {
    uint32_t firmware;    /**< which firmware this is */
    uint32_t at_sequence; /**< sequence number of the sample at the time of time_us */
    uint32_t time_us[2];  /**< a clock's time [us], the lower half first */
} amb_stamp;

/** Most bytes of a section. */
#define AMB_SECTION_BYTES 736

/** A section of a flight record, to be written down as it is. */
typedef struct amb_section {
    uint32_t length;                  /**< how many of the bytes count */
    uint8_t bytes[AMB_SECTION_BYTES]; /**< they, and zeros */
} amb_section;

/** What has happened since amb_init(). */
typedef struct amb_report {
    uint32_t landings;            /**< engagements in which the rotor touched the retainer bearing */
    uint32_t impacts;             /**< touches in them */
    uint32_t contact_ticks;       /**< ticks in contact in them */
    uint32_t missed_ticks;        /**< ticks that were missed, by the sequence number */
    uint32_t repeated_ticks;      /**< calls with the sequence number of the call before */
    uint32_t late_ticks;          /**< commands that came too late, by AMB_STATUS_LATE */
    uint32_t coast_down;          /**< 1 if coasting down was asked for and the bearing has been on since */
    uint32_t refusal;             /**< AMB_REFUSAL_ of the last sample */
    uint32_t fault;               /**< AMB_REFUSAL_ that began the last sensor fault */
    float impact_speed_max_m_s;   /**< fastest normal speed before an impact, estimated [m/s] */
    float backward_speed_max_m_s; /**< fastest backward speed in contact, estimated [m/s] */
    float whirl_limit_m_s;        /**< highest backward speed that the cap can arrest [m/s] */
    float severity_index;         /**< energy that the retainer bearing has borne, over that at the limit */
    float thermal_state;          /**< force-time budget: above 1 the cap is lowered */
    float force_cap_n;            /**< force cap now [N] */
    uint32_t nuisance_engagements; /**< engagements without a touch */
    uint32_t handed_back;         /**< times that the bearing was handed back, as an engagement made no progress */
    uint32_t finding;             /**< AMB_FINDING_: what the check of the configuration has come to */
    float finding_value;          /**< by how much, as AMB_FINDING_ says, to three digits */
} amb_report;

/** Version of the format of a ledger. */
#define AMB_LEDGER_VERSION 1
/** Bytes of a ledger as it is written down. */
#define AMB_LEDGER_BYTES 48

/** Landings of a retainer bearing since it was fitted. Only amb_ledger_ calls write to it; all of it may be looked at. */
typedef struct amb_ledger {
    uint32_t bearing;                /**< the user's number of the bearing: another one for each that is fitted */
    uint32_t updates;                /**< how often it has been added to; the lowest bit: in which of two places the next copy goes */
    float severity_allowed;          /**< severity that the bearing may bear in all */
    uint32_t landings;               /**< landings */
    uint32_t severity_millionths[2]; /**< sum of their severities, in millionths, the lower half first */
    float worst_severity;            /**< largest severity of what was added at once: a landing, with those before it that are
                                          in no record */
    float hardest_impact_m_s;        /**< fastest normal speed before an impact, of those in records [m/s] */
    uint32_t closed_at;              /**< sequence number at which the record froze that was added last */
    uint32_t run_landings;           /**< what the supervisor has counted since amb_init(), as far as it is in here already: not
                                          written down */
    uint32_t run_severity_millionths[2]; /**< the same of severity, in millionths, the lower half first */
} amb_ledger;

/** A row of the table of parameters. Its texts live as long as the program. */
typedef struct amb_parameter {
    const char *name; /**< name, as in the configuration of the Rust crate */
    const char *unit; /**< unit */
    const char *text; /**< what it is */
    float low;        /**< smallest valid value */
    float high;       /**< largest valid value */
} amb_parameter;

/** @name Sizes in bytes @{ */
#define AMB_SIZEOF_BEARING 36
#define AMB_SIZEOF_SAMPLE 36
#define AMB_SIZEOF_COMMAND 36
#define AMB_SIZEOF_ROTOR_COMMAND 84
#define AMB_SIZEOF_SHAFT 36
#define AMB_SIZEOF_EVENT 12
#define AMB_SIZEOF_STAMP 16
#define AMB_SIZEOF_SECTION 740
#define AMB_SIZEOF_REPORT 76
#define AMB_SIZEOF_LEDGER 48
/** @} */

/* The library was compiled with the same numbers: see structs.rs and storage.rs. */
AMB_ASSERT(supervisor_size, sizeof(amb_supervisor) == AMB_SUPERVISOR_BYTES);
AMB_ASSERT(rotor_size, sizeof(amb_rotor) == AMB_ROTOR_BYTES);
AMB_ASSERT(watch_size, sizeof(amb_watch) == AMB_WATCH_BYTES);
AMB_ASSERT(archive_place_size, sizeof(amb_archive_place) == AMB_ARCHIVE_PLACE_BYTES);
AMB_ASSERT(archive_size, sizeof(amb_archive) == AMB_ARCHIVE_BYTES);
AMB_ASSERT(sample_size, sizeof(amb_sample) == AMB_SIZEOF_SAMPLE);
AMB_ASSERT(sample_sequence, offsetof(amb_sample, sequence) == 0);
AMB_ASSERT(sample_status, offsetof(amb_sample, status) == 4);
AMB_ASSERT(sample_position, offsetof(amb_sample, position_m) == 8);
AMB_ASSERT(sample_spin, offsetof(amb_sample, spin_rad_s) == 16);
AMB_ASSERT(sample_levitation, offsetof(amb_sample, levitation_n) == 20);
AMB_ASSERT(sample_applied, offsetof(amb_sample, applied_n) == 28);
AMB_ASSERT(command_size, sizeof(amb_command) == AMB_SIZEOF_COMMAND);
AMB_ASSERT(command_force, offsetof(amb_command, force_n) == 0);
AMB_ASSERT(command_own, offsetof(amb_command, own_n) == 8);
AMB_ASSERT(command_severity, offsetof(amb_command, severity) == 16);
AMB_ASSERT(command_mode, offsetof(amb_command, mode) == 20);
AMB_ASSERT(command_limits, offsetof(amb_command, limits) == 24);
AMB_ASSERT(command_events, offsetof(amb_command, events) == 28);
AMB_ASSERT(command_integrator, offsetof(amb_command, integrator) == 32);
AMB_ASSERT(rotor_command_size, sizeof(amb_rotor_command) == AMB_SIZEOF_ROTOR_COMMAND);
AMB_ASSERT(rotor_command_planes, offsetof(amb_rotor_command, planes) == 0);
AMB_ASSERT(rotor_command_other_engaged, offsetof(amb_rotor_command, other_engaged) == 72);
AMB_ASSERT(rotor_command_coast_down, offsetof(amb_rotor_command, coast_down) == 80);
AMB_ASSERT(bearing_size, sizeof(amb_bearing) == AMB_SIZEOF_BEARING);
AMB_ASSERT(bearing_sample_period_s, offsetof(amb_bearing, sample_period_s) == 0);
AMB_ASSERT(bearing_mass_kg, offsetof(amb_bearing, mass_kg) == 4);
AMB_ASSERT(bearing_stiffness_n_m, offsetof(amb_bearing, stiffness_n_m) == 8);
AMB_ASSERT(bearing_clearance_m, offsetof(amb_bearing, clearance_m) == 12);
AMB_ASSERT(bearing_force_max_n, offsetof(amb_bearing, force_max_n) == 16);
AMB_ASSERT(bearing_amplifier_lag_s, offsetof(amb_bearing, amplifier_lag_s) == 20);
AMB_ASSERT(bearing_friction_coefficient, offsetof(amb_bearing, friction_coefficient) == 24);
AMB_ASSERT(bearing_contact_stiffness_n_m, offsetof(amb_bearing, contact_stiffness_n_m) == 28);
AMB_ASSERT(bearing_sensor_noise_m, offsetof(amb_bearing, sensor_noise_m) == 32);
AMB_ASSERT(shaft_size, sizeof(amb_shaft) == AMB_SIZEOF_SHAFT);
AMB_ASSERT(shaft_mass_kg, offsetof(amb_shaft, mass_kg) == 0);
AMB_ASSERT(shaft_transverse_inertia_kg_m2, offsetof(amb_shaft, transverse_inertia_kg_m2) == 4);
AMB_ASSERT(shaft_polar_inertia_kg_m2, offsetof(amb_shaft, polar_inertia_kg_m2) == 8);
AMB_ASSERT(shaft_retainer_m, offsetof(amb_shaft, retainer_m) == 12);
AMB_ASSERT(shaft_sensor_m, offsetof(amb_shaft, sensor_m) == 20);
AMB_ASSERT(shaft_magnet_m, offsetof(amb_shaft, magnet_m) == 28);
AMB_ASSERT(event_size, sizeof(amb_event) == AMB_SIZEOF_EVENT);
AMB_ASSERT(event_sequence, offsetof(amb_event, sequence) == 0);
AMB_ASSERT(event_mode, offsetof(amb_event, mode) == 4);
AMB_ASSERT(event_events, offsetof(amb_event, events) == 8);
AMB_ASSERT(stamp_size, sizeof(amb_stamp) == AMB_SIZEOF_STAMP);
AMB_ASSERT(stamp_firmware, offsetof(amb_stamp, firmware) == 0);
AMB_ASSERT(stamp_at_sequence, offsetof(amb_stamp, at_sequence) == 4);
AMB_ASSERT(stamp_time_us, offsetof(amb_stamp, time_us) == 8);
AMB_ASSERT(section_size, sizeof(amb_section) == AMB_SIZEOF_SECTION);
AMB_ASSERT(section_length, offsetof(amb_section, length) == 0);
AMB_ASSERT(section_bytes, offsetof(amb_section, bytes) == 4);
AMB_ASSERT(report_size, sizeof(amb_report) == AMB_SIZEOF_REPORT);
AMB_ASSERT(report_landings, offsetof(amb_report, landings) == 0);
AMB_ASSERT(report_impacts, offsetof(amb_report, impacts) == 4);
AMB_ASSERT(report_contact_ticks, offsetof(amb_report, contact_ticks) == 8);
AMB_ASSERT(report_missed_ticks, offsetof(amb_report, missed_ticks) == 12);
AMB_ASSERT(report_repeated_ticks, offsetof(amb_report, repeated_ticks) == 16);
AMB_ASSERT(report_late_ticks, offsetof(amb_report, late_ticks) == 20);
AMB_ASSERT(report_coast_down, offsetof(amb_report, coast_down) == 24);
AMB_ASSERT(report_refusal, offsetof(amb_report, refusal) == 28);
AMB_ASSERT(report_fault, offsetof(amb_report, fault) == 32);
AMB_ASSERT(report_impact_speed_max_m_s, offsetof(amb_report, impact_speed_max_m_s) == 36);
AMB_ASSERT(report_backward_speed_max_m_s, offsetof(amb_report, backward_speed_max_m_s) == 40);
AMB_ASSERT(report_whirl_limit_m_s, offsetof(amb_report, whirl_limit_m_s) == 44);
AMB_ASSERT(report_severity_index, offsetof(amb_report, severity_index) == 48);
AMB_ASSERT(report_thermal_state, offsetof(amb_report, thermal_state) == 52);
AMB_ASSERT(report_force_cap_n, offsetof(amb_report, force_cap_n) == 56);
AMB_ASSERT(report_nuisance_engagements, offsetof(amb_report, nuisance_engagements) == 60);
AMB_ASSERT(report_handed_back, offsetof(amb_report, handed_back) == 64);
AMB_ASSERT(report_finding, offsetof(amb_report, finding) == 68);
AMB_ASSERT(report_finding_value, offsetof(amb_report, finding_value) == 72);
AMB_ASSERT(ledger_size, sizeof(amb_ledger) == AMB_SIZEOF_LEDGER);
AMB_ASSERT(ledger_bearing, offsetof(amb_ledger, bearing) == 0);
AMB_ASSERT(ledger_updates, offsetof(amb_ledger, updates) == 4);
AMB_ASSERT(ledger_severity_allowed, offsetof(amb_ledger, severity_allowed) == 8);
AMB_ASSERT(ledger_landings, offsetof(amb_ledger, landings) == 12);
AMB_ASSERT(ledger_severity_millionths, offsetof(amb_ledger, severity_millionths) == 16);
AMB_ASSERT(ledger_worst_severity, offsetof(amb_ledger, worst_severity) == 24);
AMB_ASSERT(ledger_hardest_impact_m_s, offsetof(amb_ledger, hardest_impact_m_s) == 28);
AMB_ASSERT(ledger_closed_at, offsetof(amb_ledger, closed_at) == 32);
AMB_ASSERT(ledger_run_landings, offsetof(amb_ledger, run_landings) == 36);
AMB_ASSERT(ledger_run_severity_millionths, offsetof(amb_ledger, run_severity_millionths) == 40);
AMB_ASSERT(parameter_name, offsetof(amb_parameter, name) == 0);
AMB_ASSERT(parameter_unit, offsetof(amb_parameter, unit) == sizeof(char *));
AMB_ASSERT(parameter_text, offsetof(amb_parameter, text) == 2 * sizeof(char *));
AMB_ASSERT(parameter_low, offsetof(amb_parameter, low) == 3 * sizeof(char *));
AMB_ASSERT(parameter_high, offsetof(amb_parameter, high) == 3 * sizeof(char *) + 4);

/**
 * Version of the interface that the library speaks. The only name without a version, for programs that
 * load the library when they run.
 * @return AMB_ABI of the header that belongs to it.
 */
uint32_t amb_abi_version(void);

/**
 * What a code means, for people.
 * @param code what a call returned; any other number has a text, too.
 * @return a text that ends with zero and lives as long as the program. Never null.
 */
const char *amb_error_text(amb_code code);

/**
 * Row of the table of parameters.
 * @param index 0 to AMB_PARAMETERS - 1; anything else is AMB_ERROR_INDEX.
 * @param[out] parameter the row; untouched after an error.
 * @return AMB_OK, AMB_ERROR_INDEX, AMB_ERROR_RESULT_NULL or _MISALIGNED.
 */
amb_code amb_parameter_at(uint32_t index, amb_parameter *parameter);

/**
 * Index of a parameter, for configurations that come as text.
 * @param name its name, case counts; AMB_ERROR_NAME_UNKNOWN if there is none of it.
 * @param[out] index its index; untouched after an error.
 * @return AMB_OK, AMB_ERROR_NAME_NULL or _UNKNOWN, AMB_ERROR_RESULT_NULL or _MISALIGNED.
 */
amb_code amb_parameter_index(const char *name, uint32_t *index);

/**
 * A configuration from nine numbers: what they leave open has the default that the table of parameters in the book names. What is
 * known better goes into the place of single values before amb_init(). Takes a kilobyte of stack.
 * @param bearing the nine numbers.
 * @param[out] values value of each parameter, in the order of their indexes, as amb_init() takes them; untouched after an error.
 * @param count AMB_PARAMETERS.
 * @return AMB_OK, an error of bearing or values, or AMB_ERROR_PARAMETER(index) for the first value outside its range. For
 * sensor_noise_m that is the one of AMB_P_SENSOR_STEP_M, or of AMB_P_CONTACT_BAND where it is too much for the clearance.
 */
amb_code amb_config_for_bearing(const amb_bearing *bearing, float *values, size_t count);

/**
 * The same for both planes of a rotor: mass and ratios of a plane follow from the shaft, and all that follows from the mass with them.
 * Takes three kilobytes of stack.
 * @param shaft the rotor.
 * @param bearings two, of plane 0 and plane 1; mass_kg is not used.
 * @param[out] values those of plane 0, then those of plane 1, as amb_rotor_init() takes them; untouched after an error.
 * @param count 2 * AMB_PARAMETERS.
 * @return AMB_OK, an error of shaft, bearing or values, or AMB_ERROR_PARAMETER(index) as amb_rotor_init().
 */
amb_code amb_config_for_rotor(const amb_shaft *shaft, const amb_bearing *bearings, float *values, size_t count);

/**
 * Makes a supervisor, levitated. Takes two kilobytes of stack.
 * @param supervisor memory for it, zero or made before. After an error it is as it was.
 * @param bytes sizeof *supervisor.
 * @param values the configuration: value of each parameter, in the order of their indexes.
 * @param count AMB_PARAMETERS.
 * @return AMB_OK, an error of supervisor or values, or AMB_ERROR_PARAMETER(index) for the first value outside its
 * range; NaN is outside every range.
 */
amb_code amb_init(amb_supervisor *supervisor, size_t bytes, const float *values, size_t count);

/**
 * Self-test at boot, before the first sample: a rotor of the test's own goes through every mode by the very ticks that amb_tick()
 * makes, and all commands have to be what they were when this version was made. What the supervisor remembered is forgotten: it
 * is as amb_init() left it, and no event and no record comes of the test. Takes some milliseconds, without an FPU some tenths of
 * a second, and two kilobytes of stack. Meanwhile amb_mode() and amb_report_now() tell of the test. One of the tick's calls.
 * @param supervisor made by amb_init().
 * @return AMB_OK, AMB_ERROR_SELF_TEST: do not use the supervisor on this processor, or an error of supervisor.
 */
amb_code amb_self_test(amb_supervisor *supervisor);

/**
 * Another configuration for a supervisor that is there, to hold from its next tick on. What is known of the
 * rotor stays, and so do mode, counters and thermal state; entries of the flight record are in the units of
 * their time, and the tick of the change has AMB_EVENT_RECONFIGURED. It computes some roots and exponentials:
 * see the page on C for how long.
 * @param supervisor made by amb_init(). After an error nothing has changed.
 * @param values as for amb_init().
 * @param count AMB_PARAMETERS.
 * @return as of amb_init().
 */
amb_code amb_reconfigure(amb_supervisor *supervisor, const float *values, size_t count);

/**
 * One tick: bounded in time, whatever the sample holds.
 * @param supervisor made by amb_init().
 * @param sample what is known now.
 * @param[out] command what to do. After an error it is zero force and AMB_MODE_SENSOR_FAULT, unless
 * command itself is null or misaligned.
 * @return AMB_OK, or an error of supervisor, sample or command.
 */
amb_code amb_tick(amb_supervisor *supervisor, const amb_sample *sample, amb_command *command);

/**
 * What to add to the force that the levitation controller asks for at the next tick, so that the machine confirms its configuration:
 * a sine of 5 % of the cap for some seconds, along one axis after the other, and zero before and after. Until AMB_FINDING_PASSED
 * the supervisor only watches, as with AMB_STATUS_SHADOW, unless AMB_P_CHECK_FIRST is 0. One of the tick's calls, between two ticks.
 * @param supervisor made by amb_init().
 * @param[out] stimulus_n two floats, x and y [N]; untouched after an error.
 * @return AMB_OK, or an error of supervisor or result.
 */
amb_code amb_stimulus(amb_supervisor *supervisor, float *stimulus_n);

/**
 * What the supervisor was doing after its last tick. From anywhere, at any time.
 * @param supervisor made by amb_init().
 * @param[out] mode AMB_MODE_; untouched after an error.
 * @return AMB_OK, or an error of supervisor or result; never AMB_ERROR_BUSY.
 */
amb_code amb_mode(const amb_supervisor *supervisor, uint32_t *mode);

/**
 * Name of a mode, for people.
 * @param mode AMB_MODE_; any other number has a text, too.
 * @return a text that ends with zero and lives as long as the program. Never null.
 */
const char *amb_mode_name(uint32_t mode);

/**
 * What had happened from amb_init() to one of the last eight ticks, or sixteen where many have events, all of it of the same
 * tick; an event is in it from the tick after it on. From anywhere, at any time.
 * @param supervisor made by amb_init().
 * @param[out] report untouched after an error.
 * @return AMB_OK, or an error of supervisor or result. AMB_ERROR_BUSY where ticks came in between eight times in a row, and
 * where it is called by what has interrupted a tick.
 */
amb_code amb_report_now(const amb_supervisor *supervisor, amb_report *report);

/**
 * Takes the oldest event out of the queue of 16. Call it from the background until it is AMB_NOTHING; ticks may come meanwhile.
 * @param supervisor made by amb_init().
 * @param[out] event untouched unless AMB_OK.
 * @return AMB_OK, AMB_NOTHING, or an error of supervisor or result.
 */
amb_code amb_next_event(amb_supervisor *supervisor, amb_event *event);

/**
 * A section of the frozen flight record. AMB_NOTHING where none has frozen, and beyond the last section. The record is frozen
 * (AMB_EVENT_RECORD_FROZEN) once its ticks are full and the levitation controller has the bearing again, or the slow track is full, and stays as it is
 * until amb_rearm(), so that sections may be read one at a time, with ticks between. Written one after the other they are the file
 * that `firmware-host review` reads.
 * @param supervisor made by amb_init().
 * @param index 0 for the first.
 * @param stamp the same for all sections of a record.
 * @param[out] section untouched unless AMB_OK.
 * @return AMB_OK, AMB_NOTHING, or an error of supervisor, stamp or result.
 */
amb_code amb_record_section(amb_supervisor *supervisor, uint32_t index, const amb_stamp *stamp, amb_section *section);

/**
 * Discards a frozen record; with the next tick the recorder waits for an engagement again. Without one nothing happens.
 * @param supervisor made by amb_init().
 * @return AMB_OK, or an error of supervisor.
 */
amb_code amb_rearm(amb_supervisor *supervisor);

/**
 * Makes a supervisor of a rotor in two bearing planes, levitated: a supervisor for each, which know the force at the
 * other end and how the spin turns a tilt. Takes three kilobytes of stack.
 * @param rotor memory for it, zero or made before. After an error it is as it was.
 * @param bytes sizeof *rotor.
 * @param shaft the rotor. From it follow, for each plane, AMB_P_MASS_KG (what an impact there moves),
 * AMB_P_RETAINER_PLANE_RATIO and AMB_P_MAGNET_PLANE_RATIO: their values are not used.
 * @param values the configurations: those of plane 0 as amb_init() takes them, then those of plane 1.
 * @param count 2 * AMB_PARAMETERS.
 * @return AMB_OK, an error of rotor, shaft or values, or AMB_ERROR_PARAMETER(index) for the first value outside its range:
 * index into values, or what follows from the shaft in its place.
 */
amb_code amb_rotor_init(amb_rotor *rotor, size_t bytes, const amb_shaft *shaft, const float *values, size_t count);

/**
 * Self-test at boot, before the first samples, as amb_self_test(): both planes, and what they know of each other.
 * @param rotor made by amb_rotor_init().
 * @return AMB_OK, AMB_ERROR_SELF_TEST, or an error of rotor.
 */
amb_code amb_rotor_self_test(amb_rotor *rotor);

/**
 * Another shaft and other configurations for a rotor that is there, as amb_reconfigure().
 * @param rotor made by amb_rotor_init(). After an error nothing has changed.
 * @param shaft as for amb_rotor_init().
 * @param values as for amb_rotor_init().
 * @param count 2 * AMB_PARAMETERS.
 * @return as of amb_rotor_init().
 */
amb_code amb_rotor_reconfigure(amb_rotor *rotor, const amb_shaft *shaft, const float *values, size_t count);

/**
 * One tick of both planes: bounded in time, whatever the samples hold.
 * @param rotor made by amb_rotor_init().
 * @param samples two, of plane 0 and plane 1, taken at one instant and with one sequence number.
 * @param[out] command what to do. After an error it is zero force and AMB_MODE_SENSOR_FAULT in both planes, unless
 * command itself is null or misaligned.
 * @return AMB_OK, or an error of rotor, sample or command.
 */
amb_code amb_rotor_tick(amb_rotor *rotor, const amb_sample *samples, amb_rotor_command *command);

/**
 * The first half of a tick, of plane 0, for firmware that has no time for both planes in one period of its loop: this one in
 * one period, amb_rotor_tick_second() in the next. Each plane's AMB_P_SAMPLE_PERIOD_S is then two periods. Called twice, the
 * tick begins anew.
 * @param rotor made by amb_rotor_init().
 * @param sample of plane 0.
 * @param[out] command what to do in plane 0, but for events of its record, which come with the second half. After an error as
 * that of amb_tick().
 * @return AMB_OK, or an error of rotor, sample or command.
 */
amb_code amb_rotor_tick_first(amb_rotor *rotor, const amb_sample *sample, amb_command *command);

/**
 * The second half, of plane 1. Both halves together do what amb_rotor_tick() does with the same samples.
 * @param rotor made by amb_rotor_init(), with a first half.
 * @param sample of plane 1, taken now, with the sequence number of the first half's.
 * @param[out] command what the whole tick came to. After an error as that of amb_rotor_tick().
 * @return AMB_OK, AMB_ERROR_ROTOR_HALF, or an error of rotor, sample or command.
 */
amb_code amb_rotor_tick_second(amb_rotor *rotor, const amb_sample *sample, amb_rotor_command *command);

/**
 * As amb_stimulus(), of one plane after the other; the rotor acts once both have passed.
 * @param rotor made by amb_rotor_init().
 * @param[out] stimulus_n four floats, x and y of plane 0 and of plane 1 [N]; untouched after an error.
 * @return AMB_OK, or an error of rotor or result.
 */
amb_code amb_rotor_stimulus(amb_rotor *rotor, float *stimulus_n);

/**
 * What had happened to a plane from amb_rotor_init() to one of the last ticks, as amb_report_now(). From anywhere, at any time.
 * @param rotor made by amb_rotor_init().
 * @param plane 0 or 1; anything else is AMB_ERROR_PLANE.
 * @param[out] report untouched after an error.
 * @return AMB_OK, AMB_ERROR_PLANE, or an error of rotor or result; AMB_ERROR_ROTOR_BUSY as AMB_ERROR_BUSY there.
 */
amb_code amb_rotor_report_now(const amb_rotor *rotor, uint32_t plane, amb_report *report);

/**
 * Takes the oldest event of a plane out of its queue of 16. Call it from the background until it is AMB_NOTHING.
 * @param rotor made by amb_rotor_init().
 * @param plane 0 or 1; anything else is AMB_ERROR_PLANE.
 * @param[out] event untouched unless AMB_OK.
 * @return AMB_OK, AMB_NOTHING, AMB_ERROR_PLANE, or an error of rotor or result.
 */
amb_code amb_rotor_next_event(amb_rotor *rotor, uint32_t plane, amb_event *event);

/**
 * A section of the frozen flight record of a plane, as amb_record_section(). Both planes record the same ticks of one event and
 * freeze at once; the sections of both planes may be written into one file.
 * @param rotor made by amb_rotor_init().
 * @param plane 0 or 1; anything else is AMB_ERROR_PLANE.
 * @param index 0 for the first.
 * @param stamp the same for all sections of a record.
 * @param[out] section untouched unless AMB_OK.
 * @return AMB_OK, AMB_NOTHING, AMB_ERROR_PLANE, or an error of rotor, stamp or result.
 */
amb_code amb_rotor_record_section(amb_rotor *rotor, uint32_t plane, uint32_t index, const amb_stamp *stamp,
                                  amb_section *section);

/**
 * Discards the frozen records of both planes; with the next tick they wait for an engagement again.
 * @param rotor made by amb_rotor_init().
 * @return AMB_OK, or an error of rotor.
 */
amb_code amb_rotor_rearm(amb_rotor *rotor);

/**
 * Makes an output watch, without a command. A control loop that is no longer called must not leave its last
 * force on the magnet: where the actuator has a loop of its own, let it take its force from a watch.
 * @param watch memory for it, zero or made before.
 * @param periods a command holds for this many periods of the actuator; 0 lets none through.
 * @return AMB_OK, or an error of watch.
 */
amb_code amb_watch_init(amb_watch *watch, uint32_t periods);

/**
 * After each tick.
 * @param watch made by amb_watch_init().
 * @param force two floats, as in amb_command: the actuator's from now on. After an error it keeps the one
 * that it had, until that expires.
 * @return AMB_OK, or an error of watch or force.
 */
amb_code amb_watch_renew(amb_watch *watch, const float *force);

/**
 * Once in each period of the actuator.
 * @param watch made by amb_watch_init().
 * @param[out] force two floats: the actuator's, zero when the command has expired, and after an error, unless
 * force itself is null or misaligned.
 * @return AMB_OK, or an error of watch or force.
 */
amb_code amb_watch_force(amb_watch *watch, float *force);

/**
 * Whether the next period would have no command.
 * @param watch made by amb_watch_init().
 * @param[out] expired 0 or 1; untouched after an error.
 * @return AMB_OK, or an error of watch or result.
 */
amb_code amb_watch_expired(amb_watch *watch, uint32_t *expired);

/**
 * Ledger of a retainer bearing without landings: once, when the bearing is fitted. Write it to both places of the memory that
 * keeps it. A ledger is told apart from one that was lost: amb_ledger_read() of memory that nobody has written to is an error.
 * @param bearing the user's number of the bearing.
 * @param severity_allowed severity that it may bear in all; below 0 or no number counts as 0.
 * @param[out] ledger untouched after an error.
 * @return AMB_OK, or an error of ledger.
 */
amb_code amb_ledger_new(uint32_t bearing, float severity_allowed, amb_ledger *ledger);

/**
 * Ledger from what was written down: once for each amb_init(), as all that the supervisor has counted since then will be added.
 * @param bytes as amb_ledger_write() gave them.
 * @param count AMB_LEDGER_BYTES.
 * @param[out] ledger untouched after an error: then there are no figures.
 * @return AMB_OK, AMB_ERROR_BYTES_NULL, AMB_ERROR_LEDGER_LENGTH, _BLANK, _LETTERS, _DAMAGED or _VERSION, or an error of ledger.
 */
amb_code amb_ledger_read(const uint8_t *bytes, size_t count, amb_ledger *ledger);

/**
 * The newer of two copies, which are written in turn (updates) so that one of them is whole whenever the power fails.
 * @param first one copy.
 * @param second the other.
 * @param count AMB_LEDGER_BYTES, of each.
 * @param[out] ledger untouched unless AMB_OK or AMB_ONE_COPY.
 * @return AMB_OK, AMB_ONE_COPY, AMB_ERROR_LEDGER_BEARINGS where the copies are of two bearings, or as amb_ledger_read().
 */
amb_code amb_ledger_newer(const uint8_t *first, const uint8_t *second, size_t count, amb_ledger *ledger);

/**
 * Adds the frozen flight record, and the landings before it that are in none. Call it before amb_rearm(); the same record once
 * more adds nothing. One of the reader's calls.
 * @param[in,out] ledger from amb_ledger_read() or amb_ledger_new(); untouched unless AMB_OK.
 * @param supervisor made by amb_init().
 * @return AMB_OK: write it down; AMB_NOTHING: there is no record, or nothing new in it; or an error of ledger or supervisor.
 */
amb_code amb_ledger_take_in(amb_ledger *ledger, amb_supervisor *supervisor);

/**
 * The same of a plane of a rotor, with a ledger for each of its bearings.
 * @param[in,out] ledger as for amb_ledger_take_in().
 * @param rotor made by amb_rotor_init().
 * @param plane 0 or 1; anything else is AMB_ERROR_PLANE.
 * @return as of amb_ledger_take_in().
 */
amb_code amb_ledger_take_in_plane(amb_ledger *ledger, amb_rotor *rotor, uint32_t plane);

/**
 * A ledger as it is to be written down, with a checksum.
 * @param ledger the ledger.
 * @param[out] bytes untouched after an error.
 * @param count AMB_LEDGER_BYTES.
 * @return AMB_OK, AMB_ERROR_BYTES_NULL, AMB_ERROR_LEDGER_LENGTH, or an error of ledger.
 */
amb_code amb_ledger_write(const amb_ledger *ledger, uint8_t *bytes, size_t count);

/**
 * How many landings of a severity the bearing may still bear, by the rule of Palmgren and Miner: what is left of its allowance
 * over the severity.
 * @param ledger the ledger.
 * @param severity of one landing, as worst_severity.
 * @param[out] landings untouched unless AMB_OK.
 * @return AMB_OK, AMB_NOTHING where the severity is not above 0, or an error of ledger or result.
 */
amb_code amb_ledger_landings_left(const amb_ledger *ledger, float severity, uint32_t *landings);

/**
 * Makes an archive without a record.
 * @param archive memory for it, zero or made before.
 * @param places room for the records, used by nothing else from now on; what was in it is forgotten.
 * @param count how many places there are: events that are kept at a time, 1 or more.
 * @return AMB_OK, AMB_ERROR_PLACES_COUNT, or an error of archive or places.
 */
amb_code amb_archive_init(amb_archive *archive, amb_archive_place *places, size_t count);

/**
 * Copies the frozen flight record, if there is one, and discards it: with the next tick the supervisor waits for an engagement
 * again. In place of amb_rearm(), and after amb_ledger_take_in(). Where no place is free the oldest record goes.
 * @param archive made by amb_archive_init().
 * @param supervisor made by amb_init().
 * @return AMB_OK, AMB_NOTHING where none has frozen, or an error of archive or supervisor.
 */
amb_code amb_archive_take(amb_archive *archive, amb_supervisor *supervisor);

/**
 * The same of both planes of a rotor, which freeze at once. Give both archives the same number of places.
 * @param first of plane 0, made by amb_archive_init().
 * @param second of plane 1; the first once more is AMB_ERROR_ARCHIVE_BUSY.
 * @param rotor made by amb_rotor_init().
 * @return AMB_OK, AMB_NOTHING, or an error of an archive or of rotor.
 */
amb_code amb_archive_take_rotor(amb_archive *first, amb_archive *second, amb_rotor *rotor);

/**
 * How many records there are.
 * @param archive made by amb_archive_init().
 * @param[out] count untouched after an error.
 * @return AMB_OK, or an error of archive or result.
 */
amb_code amb_archive_count(amb_archive *archive, uint32_t *count);

/**
 * A section of the oldest record, as amb_record_section() of a frozen one. It says how many events are in no record before it.
 * @param archive made by amb_archive_init().
 * @param index 0 for the first.
 * @param stamp the same for all sections of a record.
 * @param[out] section untouched unless AMB_OK.
 * @return AMB_OK, AMB_NOTHING where there is no record or all of it has been given, or an error of archive, stamp or result.
 */
amb_code amb_archive_section(amb_archive *archive, uint32_t index, const amb_stamp *stamp, amb_section *section);

/**
 * Makes room where the oldest record was, once it is written down.
 * @param archive made by amb_archive_init().
 * @return AMB_OK, AMB_NOTHING where there is none, or an error of archive.
 */
amb_code amb_archive_discard(amb_archive *archive);

#ifdef __cplusplus
}
#endif

#endif
