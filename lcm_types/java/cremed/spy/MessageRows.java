// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
package cremed.spy;

import cremed.ego_motion_t;
import cremed.radar_scan_t;
import java.lang.reflect.Array;
import java.lang.reflect.Field;
import java.lang.reflect.Modifier;
import java.util.ArrayList;
import java.util.List;
import java.util.Locale;
import java.util.Map;
import java.util.StringJoiner;

/** A message as rows of name and value, with the names of codes in place of numbers. */
public final class MessageRows {
  /** The constants that a field's value is one of, or a sum of. */
  private record Code(String prefix, boolean isSum) {}

  private static final Map<String, Code> CODES =
      Map.of(
          "status", new Code("STATUS_", false),
          "last_motion_status", new Code("STATUS_", false),
          "link_state", new Code("LINK_", false),
          "bus_state", new Code("BUS_", false),
          "radar_output", new Code("OUTPUT_", false),
          "odometry_fault", new Code("CAUSE_", false),
          "radar_faults", new Code("FAULT_", true),
          "doubts", new Code("DOUBT_", true));
  /** Arrays of a status_t: their places have the names of these constants. */
  private static final Map<String, String> LISTS =
      Map.of("counters", "COUNTER_", "figures", "FIGURE_");
  private static final int LONGEST_ARRAY = 16;

  private MessageRows() {}

  public static List<String[]> of(Object message) {
    List<String[]> rows = new ArrayList<>();
    try {
      for (Field field : message.getClass().getFields()) {
        if (LISTS.containsKey(field.getName())) {
          addNamed(LISTS.get(field.getName()), field.get(message), message.getClass(), rows);
        } else if (!Modifier.isStatic(field.getModifiers())) {
          rows.add(new String[] {field.getName(), text(field, message)});
        }
      }
    } catch (IllegalAccessException e) {
      throw new IllegalStateException(e);
    }
    return rows;
  }

  private static void addNamed(String prefix, Object values, Class<?> type, List<String[]> rows)
      throws IllegalAccessException {
    for (Field constant : type.getFields()) {
      if (constant.getName().startsWith(prefix)) {
        String name = constant.getName().substring(prefix.length()).toLowerCase(Locale.ROOT);
        rows.add(new String[] {name, number(Array.get(values, constant.getInt(null)))});
      }
    }
  }

  /** The name of the message's status, as "standing_still". */
  static String status(Object message) {
    try {
      return text(message.getClass().getField("status"), message);
    } catch (ReflectiveOperationException e) {
      throw new IllegalStateException(e);
    }
  }

  private static String text(Field field, Object message) throws IllegalAccessException {
    Object value = field.get(message);
    if (value == null || value instanceof String || value instanceof Boolean) {
      return String.valueOf(value);
    }
    if (value.getClass().isArray()) {
      return array(value);
    }
    Code code = CODES.get(field.getName());
    return code != null ? named(code, field, message) : number(value);
  }

  private static String array(Object values) {
    int length = Array.getLength(values);
    if (length > LONGEST_ARRAY) {
      return length + " values";
    }
    StringJoiner text = new StringJoiner("  ");
    for (int i = 0; i < length; ++i) {
      text.add(number(Array.get(values, i)));
    }
    return text.toString();
  }

  private static String number(Object value) {
    return value instanceof Double || value instanceof Float
        ? String.format(Locale.ROOT, "%.5g", ((Number) value).doubleValue())
        : value.toString();
  }

  private static String named(Code code, Field field, Object message)
      throws IllegalAccessException {
    // The constants of a motion's status are in the motion's message.
    Class<?> holder =
        field.getName().equals("last_motion_status") ? ego_motion_t.class : message.getClass();
    String prefix = message instanceof radar_scan_t ? "SCAN_" : code.prefix;  // Of its status.
    int value = ((Number) field.get(message)).intValue();
    StringJoiner names = new StringJoiner(", ");
    for (Field constant : holder.getFields()) {
      if (Modifier.isStatic(constant.getModifiers()) && constant.getName().startsWith(prefix)) {
        int number = ((Number) constant.get(null)).intValue();
        if (code.isSum ? (value & number) != 0 : value == number) {
          names.add(constant.getName().substring(prefix.length()).toLowerCase(Locale.ROOT));
        }
      }
    }
    return names.length() > 0 ? names.toString() : code.isSum && value == 0 ? "none" : "" + value;
  }
}
