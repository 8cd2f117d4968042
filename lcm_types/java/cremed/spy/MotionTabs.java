// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
package cremed.spy;

import java.util.HashMap;
import java.util.List;
import java.util.Map;
import javax.swing.JTabbedPane;

/** The curves of each source on a channel. */
final class MotionTabs extends JTabbedPane {
  private final Map<String, MotionCurves> curves = new HashMap<>();

  void add(List<MotionSample> samples) {
    for (MotionSample sample : samples) {
      curves.computeIfAbsent(sample.source(), this::tab).add(sample);
    }
    if (getSelectedComponent() instanceof MotionCurves selected) {
      selected.draw();
    }
  }

  private MotionCurves tab(String source) {
    MotionCurves added = new MotionCurves();
    addTab(source, added);
    return added;
  }
}
