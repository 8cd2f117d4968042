// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A user in the process of cremed-spy, as a Java agent with the argument CHANNEL,SECONDS,IMAGE: opens
// the channel's window by a double click, waits until the screen shows curves, bands and the status
// "ok" over that many seconds, saves what it shows, and ends the process.
import java.awt.Color;
import java.awt.Component;
import java.awt.Container;
import java.awt.Frame;
import java.awt.Point;
import java.awt.Rectangle;
import java.awt.Robot;
import java.awt.event.InputEvent;
import java.awt.image.BufferedImage;
import java.io.File;
import java.util.List;
import java.util.concurrent.Callable;
import java.util.concurrent.FutureTask;
import java.util.stream.Stream;
import javax.imageio.ImageIO;
import javax.swing.JTable;
import javax.swing.SwingUtilities;

public final class SpyUser {
  private static final Color LINE = new Color(0x0D47A1);
  private static final Color BAND = new Color(0xBBDEFB);
  private static final Color OK = new Color(0x66BB6A);
  private static final long LIMIT_NS = 200_000_000_000L;
  private static final double SPAN_S = 30;
  private static final String REPLAY = "replay"; // Asks window_test for a replay from the start.

  private final Robot robot;
  private final String channel;
  private final double seconds;

  private SpyUser(String channel, double seconds) throws Exception {
    robot = new Robot();
    this.channel = channel;
    this.seconds = seconds;
  }

  public static void premain(String argument) {
    String[] words = argument.split(",");
    new Thread(() -> run(words[0], Double.parseDouble(words[1]), new File(words[2]))).start();
  }

  private static void run(String channel, double seconds, File image) {
    try {
      SpyUser user = new SpyUser(channel, seconds);
      ImageIO.write(user.look(), "png", image);
      System.exit(0);
    } catch (Throwable e) {
      e.printStackTrace();
      System.exit(1);
    }
  }

  private BufferedImage look() throws Exception {
    JTable channels = (JTable) wait("lcm-spy", () -> part(frame("LCM Spy"), "JTable").get(0));
    System.out.println(REPLAY);
    Frame window = wait(channel + "'s window", () -> opened(channels));
    System.out.println(REPLAY); // What was drawn stays: no later replay replaces it.
    return wait("curves in the window", () -> seen(window));
  }

  /** Clicks until there is a window: a click misses if rows change at that moment. */
  private Frame opened(JTable channels) throws Exception {
    if (frame(channel) == null) {
      Point place = onEventThread(() -> place(channels));
      robot.mouseMove(place.x, place.y);
      for (int click = 0; click < 2; ++click) {
        robot.mousePress(InputEvent.BUTTON1_DOWN_MASK);
        robot.mouseRelease(InputEvent.BUTTON1_DOWN_MASK);
      }
      robot.waitForIdle();
    }
    return frame(channel);
  }

  private Point place(JTable channels) {
    for (int row = 0; row < channels.getRowCount(); ++row) {
      if (channel.equals(channels.getValueAt(row, 0))) {
        Rectangle cell = channels.getCellRect(row, 0, true);
        Point place = new Point(cell.x + cell.width / 2, cell.y + cell.height / 2);
        SwingUtilities.convertPointToScreen(place, channels);
        return place;
      }
    }
    throw new IllegalStateException(channel + " is not in the table");
  }

  private BufferedImage seen(Frame window) throws Exception {
    BufferedImage image = robot.createScreenCapture(window.getBounds());
    for (int chart = 0; chart < 2; ++chart) {
      require(window, image, part(window, "MotionChart").get(chart), LINE);
      require(window, image, part(window, "MotionChart").get(chart), BAND);
    }
    require(window, image, part(window, "StatusStrip").get(0), OK);
    return image;
  }

  private void require(Frame window, BufferedImage image, Component part, Color color) {
    Rectangle area = SwingUtilities.convertRectangle(part.getParent(), part.getBounds(), window);
    int columns = 0;
    for (int x = area.x; x < area.x + area.width; ++x) {
      columns += hasColor(image.getSubimage(x, area.y, 1, area.height), color) ? 1 : 0;
    }
    if (columns < 0.8 * seconds / SPAN_S * area.width) {
      throw new IllegalStateException(
          part.getClass() + " has " + color + " in " + columns + " of " + area.width + " columns");
    }
  }

  private static boolean hasColor(BufferedImage column, Color color) {
    for (int y = 0; y < column.getHeight(); ++y) {
      if ((column.getRGB(0, y) & 0xFFFFFF) == (color.getRGB() & 0xFFFFFF)) {
        return true;
      }
    }
    return false;
  }

  private static Frame frame(String title) {
    return Stream.of(Frame.getFrames())
        .filter(frame -> frame.isShowing() && title.equals(frame.getTitle()))
        .findFirst()
        .orElse(null);
  }

  private static List<Component> part(Container whole, String type) {
    return parts(whole).filter(part -> part.getClass().getSimpleName().equals(type)).toList();
  }

  private static Stream<Component> parts(Container whole) {
    return Stream.of(whole.getComponents())
        .flatMap(
            part ->
                part instanceof Container container
                    ? Stream.concat(Stream.of(part), parts(container))
                    : Stream.of(part));
  }

  private static <T> T onEventThread(Callable<T> call) throws Exception {
    FutureTask<T> task = new FutureTask<>(call);
    SwingUtilities.invokeAndWait(task);
    return task.get();
  }

  /** What `look` returns, once it neither fails nor returns null. */
  private static <T> T wait(String what, Callable<T> look) throws Exception {
    Exception reason = null;
    for (long end = System.nanoTime() + LIMIT_NS; System.nanoTime() < end; Thread.sleep(300)) {
      try {
        T found = look.call();
        if (found != null) {
          return found;
        }
      } catch (RuntimeException | java.util.concurrent.ExecutionException e) {
        reason = e;
      }
    }
    throw new IllegalStateException("no " + what, reason);
  }
}
