# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""cremed's messages as those of ROS 2."""
import math

import cremed
from cdr import Definitions
from scene import BASE, ODOM, POINT, POINT_FIELDS, USABLE, RadarFrames, mount_of, points_of, pose_of

DEFINITIONS = Definitions({
    "builtin_interfaces/Time": "int32 sec\nuint32 nanosec\n",
    "std_msgs/Header": "builtin_interfaces/Time stamp\nstring frame_id\n",
    "geometry_msgs/Point": "float64 x\nfloat64 y\nfloat64 z\n",
    "geometry_msgs/Vector3": "float64 x\nfloat64 y\nfloat64 z\n",
    "geometry_msgs/Quaternion": "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n",
    "geometry_msgs/Pose": "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n",
    "geometry_msgs/PoseWithCovariance": "geometry_msgs/Pose pose\nfloat64[36] covariance\n",
    "geometry_msgs/Twist": "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n",
    "geometry_msgs/TwistWithCovariance": "geometry_msgs/Twist twist\nfloat64[36] covariance\n",
    "nav_msgs/Odometry": "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
                         "geometry_msgs/TwistWithCovariance twist\n",
    "geometry_msgs/Transform": "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n",
    "geometry_msgs/TransformStamped": "std_msgs/Header header\nstring child_frame_id\n"
                                      "geometry_msgs/Transform transform\n",
    "tf2_msgs/TFMessage": "geometry_msgs/TransformStamped[] transforms\n",
    "sensor_msgs/PointField": "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\n"
                              "uint8 UINT32=6\nuint8 FLOAT32=7\nuint8 FLOAT64=8\n"
                              "string name\nuint32 offset\nuint8 datatype\nuint32 count\n",
    "sensor_msgs/PointCloud2": "std_msgs/Header header\nuint32 height\nuint32 width\n"
                               "sensor_msgs/PointField[] fields\nbool is_bigendian\nuint32 point_step\n"
                               "uint32 row_step\nuint8[] data\nbool is_dense\n",
    "diagnostic_msgs/KeyValue": "string key\nstring value\n",
    "diagnostic_msgs/DiagnosticStatus": "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\n"
                                        "byte level\nstring name\nstring message\nstring hardware_id\n"
                                        "diagnostic_msgs/KeyValue[] values\n",
    "diagnostic_msgs/DiagnosticArray": "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n",
})
OK, WARN, ERROR, STALE = range(4)
SILENT_S = 1.0  # After that what was said last is no longer the state.
# Variance of z, roll and pitch, which are not estimated; as cremed's own nav_msgs.Odometry.
UNKNOWN_VARIANCE = 1e6
LATEST_US = (1 << 31) * 1_000_000 - 1  # builtin_interfaces/Time has an int32 of seconds.
X_Y_YAW = (0, 1, 5)  # Of x, y, z, roll, pitch, yaw.
NUMERIC_TYPES = {"B": 2, "H": 4, "f": 7}  # Of sensor_msgs/PointField.
# odometry_t.STATUS_* that can be used; of the others a filter would take a guess for a measurement.
LEVELS = {cremed.odometry_t.STATUS_OK: OK, cremed.odometry_t.STATUS_STANDING_STILL: OK,
          cremed.odometry_t.STATUS_PREDICTED: WARN, cremed.odometry_t.STATUS_INITIALISING: WARN}


def names_of(kind, prefix):
    return {number: name.replace("_", " ") for number, name in cremed.names_of(kind, prefix).items()}


STATUS_NAMES = names_of(cremed.odometry_t, "STATUS_")
MOTION_NAMES = names_of(cremed.ego_motion_t, "STATUS_")
DOUBT_NAMES = names_of(cremed.status_t, "DOUBT_")
FAULT_NAMES = names_of(cremed.status_t, "FAULT_")
CAUSE_NAMES = names_of(cremed.status_t, "CAUSE_")


def header(utime, frame):
    return {"stamp": {"sec": utime // 1_000_000, "nanosec": utime % 1_000_000 * 1000}, "frame_id": frame}


def turned(yaw):
    return {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}


def in_six(covariance):
    """Of x, y, yaw, by rows."""
    values = [0.0] * 36
    values[14] = values[21] = values[28] = UNKNOWN_VARIANCE
    for row, to_row in enumerate(X_Y_YAW):
        for column, to_column in enumerate(X_Y_YAW):
            values[6 * to_row + to_column] = covariance[3 * row + column]
    return values


def odometry(message):
    return {"header": header(message.utime, ODOM), "child_frame_id": BASE,
            "pose": {"pose": {"position": {"x": message.x_in_odom_frame_m, "y": message.y_in_odom_frame_m},
                              "orientation": turned(message.yaw_in_odom_frame_rad)},
                     "covariance": in_six(message.covariance_x_y_yaw_in_odom_frame_m_rad)},
            "twist": {"twist": {"linear": {"x": message.vx_in_vehicle_frame_mps,
                                           "y": message.vy_in_vehicle_frame_mps},
                                "angular": {"z": message.yaw_rate_radps}},
                      "covariance": in_six(message.covariance_vx_vy_yaw_rate_in_vehicle_frame_mps_radps)}}


def transform(utime, frame, child, x, y, yaw):
    return {"transforms": [{"header": header(utime, frame), "child_frame_id": child,
                            "transform": {"translation": {"x": x, "y": y}, "rotation": turned(yaw)}}]}


def cloud(scan, frame):
    data = points_of(scan)
    return {"header": header(scan.utime, frame), "height": 1, "width": scan.num_detections,
            "fields": [{"name": name, "offset": offset, "datatype": NUMERIC_TYPES[kind], "count": 1}
                       for name, offset, kind in POINT_FIELDS],
            "point_step": POINT.size, "row_step": len(data), "data": data, "is_dense": all(map(math.isfinite, (*scan.range_m, *scan.azimuth_rad)))}


def seconds_between(begin_us, end_us):
    return (end_us - begin_us) * 1e-6


def set_bits(names, bits):
    return [name for bit, name in sorted(names.items()) if bits & bit]


def radar_status(message):
    """A diagnostic_msgs/DiagnosticStatus: what is wrong with a radar, and all counters."""
    wrong = set_bits(DOUBT_NAMES, message.doubts) + set_bits(FAULT_NAMES, message.radar_faults)
    if message.odometry_leaves_out:
        wrong.append(f"left out, cause {CAUSE_NAMES.get(message.odometry_fault, 'unknown')}")
    is_good = MOTION_NAMES.get(message.last_motion_status) in ("ok", "standing still")
    level = WARN if wrong or not is_good else OK
    silent_s = seconds_between(message.utime_last_estimate, message.utime)
    if is_good and silent_s > SILENT_S:  # After a scan without estimate the status is another.
        level = STALE
        wrong.append(f"no scan for {silent_s:.0f} s")
    text = "; ".join(wrong) or MOTION_NAMES.get(message.last_motion_status, "unknown")
    values = [{"key": name, "value": str(value)} for name, value in cremed.fields_of(message).items() if name != "source"]
    return {"level": level, "name": f"cremed: {message.source}", "message": text, "hardware_id": message.source,
            "values": values}


class Ros2Profile:
    """What MCAP and its readers call ros2: (topic, name of its type, message) of a message of cremed."""
    name, encoding, schema_encoding = "ros2", "cdr", "ros2msg"

    def __init__(self):
        self.status = self.status_us = None  # Of the odometry, and its time.
        self.too_late = self.damaged = 0  # Messages that are left out.
        self.frames = RadarFrames()
        self.missing = ("has no scans, so there is no /radar_NAME/points: record with output.publish_scans = true, or "
                        "with `cremed --publish-scans`")
        self.take = {cremed.odometry_t: self.of_odometry, cremed.radar_scan_t: self.of_scan,
                     cremed.status_t: self.of_status, cremed.ego_motion_t: lambda message: []}

    def schema(self, kind):
        package, name = kind.split("/")
        return f"{package}/msg/{name}", DEFINITIONS.schema(kind)

    def records(self, message):
        """[(topic, name of its type, bytes)]"""
        if message.utime > LATEST_US:
            self.too_late += 1
            return []
        try:
            return [(topic, kind, DEFINITIONS.encode(kind, content))
                    for topic, kind, content in self.take[type(message)](message)]
        except ValueError:  # Of math.cos.
            self.damaged += 1
            return []

    def left_out(self):
        reasons = []
        if self.too_late:
            reasons.append(f"{self.too_late} messages are left out: their times are after January 2038, which ROS 2 "
                           "cannot express; was the clock right? --profile json has them")
        if self.damaged:
            reasons.append(f"{self.damaged} messages are left out: they hold an infinite angle; is the log damaged? --profile "
                           "json has what else they hold")
        return "; ".join(reasons)

    def of_odometry(self, message):
        found = []
        self.status_us = message.utime
        if message.status != self.status:
            self.status = message.status
            found.append(("/diagnostics", "diagnostic_msgs/DiagnosticArray",
                          {"header": header(message.utime, ""), "status": [self.odometry_status(message.utime)]}))
        if message.status in USABLE:
            found.append(("/odom", "nav_msgs/Odometry", odometry(message)))
            found.append(("/tf", "tf2_msgs/TFMessage", transform(message.utime, ODOM, BASE, *pose_of(message))))
        return found

    def of_scan(self, message):
        """With its mount: /tf_static is lost on who joins late, where a player does not know that it must last."""
        self.missing = ""
        frame = self.frames.of(message.source)
        return [(f"/{frame}/points", "sensor_msgs/PointCloud2", cloud(message, frame)),
                ("/tf", "tf2_msgs/TFMessage", transform(message.utime, BASE, frame, *mount_of(message)))]

    def of_status(self, message):
        statuses = [radar_status(message)]
        if self.status is not None:
            statuses.append(self.odometry_status(message.utime))
        return [("/diagnostics", "diagnostic_msgs/DiagnosticArray",
                 {"header": header(message.utime, ""), "status": statuses})]

    def odometry_status(self, utime):
        level, text = LEVELS.get(self.status, ERROR), STATUS_NAMES.get(self.status, "unknown")
        silent_s = seconds_between(self.status_us, utime)
        if silent_s > SILENT_S:
            level, text = STALE, f"no message for {silent_s:.0f} s, the last was {text}"
        return {"level": level, "name": "cremed: odometry", "message": text, "hardware_id": "cremed"}
