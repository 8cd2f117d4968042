// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What cremed-spy's table shows of each message of an LCM log: PrintRows LOG
import cremed.ego_motion_t;
import cremed.odometry_t;
import cremed.radar_scan_t;
import cremed.spy.MessageRows;
import cremed.spy.MessageWindow;
import cremed.status_t;
import java.io.EOFException;
import lcm.logging.Log;

public final class PrintRows {
  private static Object message(Log.Event event) throws Exception {
    switch (event.channel) {
      case "CREMED_ODOMETRY":
        return new odometry_t(event.data);
      case "CREMED_EGO_MOTION":
        return new ego_motion_t(event.data);
      case "CREMED_STATUS":
        return new status_t(event.data);
      default:
        return event.channel.startsWith("CREMED_SCAN_") ? new radar_scan_t(event.data) : null;
    }
  }

  public static void main(String[] arguments) throws Exception {
    if (!new MessageWindow().canHandle(odometry_t.LCM_FINGERPRINT)) {
      throw new IllegalStateException("the plugin does not take odometry_t");
    }
    Log log = new Log(arguments[0], "r");
    try {
      while (true) {
        Log.Event event = log.readNext();
        Object message = message(event);
        if (message != null) {
          System.out.print(event.channel);
          for (String[] row : MessageRows.of(message)) {
            System.out.print("\t" + row[0] + "=" + row[1]);
          }
          System.out.println();
        }
      }
    } catch (EOFException end) {
      return;
    }
  }
}
