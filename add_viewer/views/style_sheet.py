"""The style sheet of every window: $names stand for colours of the theme; $tick, $up, $down for files of its icons."""

from __future__ import annotations

from string import Template

STYLE_SHEET = Template("""
QMainWindow::separator { background: $line; width: 1px; height: 1px; }
DockTitle { border-bottom: 1px solid $line; }
QTabBar { background: $window; }
QTabBar::tab { background: transparent; border: none; border-top: 2px solid transparent; padding: 5px 12px;
    color: $muted; }
QTabBar::tab:selected { color: $text; border-top-color: $accent; }
QTabBar::tab:hover { color: $text; }
QTabBar::tab:selected:focus { border: 2px solid $accent; border-radius: 4px; padding: 4px 10px 3px 10px; }
QMenuBar { background: $window; padding: 2px 4px; border-bottom: 1px solid $line; }
QMenuBar::item { padding: 4px 8px; border-radius: 4px; background: transparent; }
QMenuBar::item:selected, QMenu::item:selected { background: $accent; color: $on_accent; }
QMenu { background: $panel; border: 1px solid $line; padding: 4px; }
QMenu::item { padding: 5px 28px 5px 24px; border-radius: 4px; }
QMenu::item:disabled { color: $muted; }
QMenu::icon:checked { border: 1px solid $accent; border-radius: 3px; padding: 2px; }
QDialogButtonBox { dialogbuttonbox-buttons-have-icons: 0; }
QCheckBox { spacing: 8px; }
QCheckBox::indicator { width: 12px; height: 12px; border: 1px solid $muted; border-radius: 3px;
    background: $field; }
QCheckBox::indicator:checked { background: $accent; border-color: $accent; image: url("$tick"); }
QCheckBox::indicator:disabled { border-color: $line; }
QCheckBox::indicator:checked:disabled { background: $muted; border-color: $muted; }
QCheckBox::indicator:focus { border: 2px solid $text; width: 10px; height: 10px; }
QMenu::separator { height: 1px; background: $line; margin: 4px 8px; }
QStatusBar { background: $window; border-top: 1px solid $line; }
QStatusBar QLabel { color: $muted; padding: 0 8px; }
QStatusBar::item { border: none; }
QLineEdit { background: $field; border: 1px solid $line; border-radius: 4px; padding: 3px 6px;
    min-height: 18px; selection-background-color: $accent; selection-color: $on_accent; }
QLineEdit:focus { border: 1px solid $accent; }
QComboBox, QAbstractSpinBox { background: $panel; border: 1px solid $line; border-radius: 4px; padding: 3px 8px;
    min-height: 20px; selection-background-color: $accent; selection-color: $on_accent; }
QAbstractSpinBox { background: $field; }
QAbstractSpinBox QLineEdit { border: none; background: transparent; padding: 0 4px; }
QComboBox:hover, QAbstractSpinBox:hover { border-color: $muted; }
QComboBox:focus, QAbstractSpinBox:focus { border: 2px solid $accent; padding: 2px 7px; }
QComboBox:disabled, QAbstractSpinBox:disabled { color: $muted; background: transparent; }
QComboBox::drop-down { border: none; width: 20px; }
QComboBox::down-arrow { image: url("$down"); width: 12px; height: 12px; }
QComboBox QAbstractItemView { background: $panel; border: 1px solid $line; padding: 4px; outline: none; }
QAbstractSpinBox::up-button, QAbstractSpinBox::down-button { border: none; background: transparent; width: 18px; }
QAbstractSpinBox::up-arrow { image: url("$up"); width: 10px; height: 10px; }
QAbstractSpinBox::down-arrow { image: url("$down"); width: 10px; height: 10px; }
QPushButton, QToolButton { background: $panel; border: 1px solid $line; border-radius: 4px;
    padding: 4px 10px; min-height: 18px; }
QToolButton { padding: 4px; }
QToolButton:disabled, QPushButton:disabled { color: $muted; background: transparent; }
QToolButton[link="true"] { border: none; background: transparent; color: $accent; padding: 1px 0; min-height: 16px; }
QToolButton[link="true"]:hover, QToolButton[link="true"]:focus { text-decoration: underline; }
QPushButton[choice="true"] { text-align: left; padding: 4px 8px; }
QToolButton[quiet="true"] { border: 1px solid transparent; background: transparent; }
QPushButton[recent="true"] { border: 1px solid transparent; background: transparent; padding: 4px 0; text-align: left; }
QPushButton:hover, QToolButton:hover { border-color: $muted; }
QPushButton:pressed, QToolButton:pressed, QToolButton:checked, QPushButton:checked { border-color: $accent;
    color: $accent; }
QPushButton:focus { border: 2px solid $accent; padding: 3px 9px; }
QPushButton[choice="true"]:focus { padding: 3px 7px; }
QToolButton:focus { border: 2px solid $accent; padding: 3px; }
QPushButton[recent="true"]:hover { color: $accent; border-color: transparent; }
QPushButton[recent="true"]:focus { border: none; padding: 5px 1px; color: $accent; text-decoration: underline; }
QToolButton[link="true"]:focus { border: none; padding: 1px 0; }
QPushButton[primary="true"] { background: $accent; color: $on_accent; border-color: $accent;
    font-weight: 600; padding: 6px 16px; }
QPushButton[primary="true"]:disabled { background: $line; color: $muted; border-color: $line; }
QPushButton[primary="true"]:focus { border: 2px solid $text; padding: 5px 15px; }
QToolTip { background: $panel; color: $text; border: 1px solid $line; padding: 4px; }
QLabel[role="muted"] { color: $muted; }
QLabel[role="heading"] { font-weight: 600; }
QLabel[role="key"] { color: $text; background: $field; border: 1px solid $line; border-radius: 4px; padding: 1px 6px; }
ShapeList::item { padding: 4px 4px; border: 1px solid transparent; border-radius: 4px; color: $text; }
ShapeList::item:hover { background: $field; }
ShapeList::item:selected { background: $field; border: 1px solid $line; color: $text; }
ShapeList::item:selected:focus { border: 2px solid $accent; padding: 3px 3px; }
ShapeList::indicator { width: 11px; height: 11px; border: 1px solid $muted; border-radius: 3px; background: $field; }
ShapeList::indicator:checked { background: $accent; border-color: $accent; image: url("$tick"); }
QScrollArea, QListView { border: none; background: transparent; }
QScrollBar { background: transparent; border: none; margin: 0; }
QScrollBar:vertical { width: 10px; }
QScrollBar:horizontal { height: 10px; }
QScrollBar::handle { background: $line; border-radius: 4px; margin: 1px; min-height: 32px; min-width: 32px; }
QScrollBar::handle:hover { background: $muted; }
QScrollBar::add-line, QScrollBar::sub-line { width: 0; height: 0; }
QScrollBar::add-page, QScrollBar::sub-page { background: transparent; }
QProgressBar { border: none; border-radius: 2px; background: $line; max-height: 4px; }
QProgressBar::chunk { background: $accent; border-radius: 2px; }
""")
